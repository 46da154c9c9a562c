# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Which messages the set-up builds."""

from pathlib import Path
import shlex
import subprocess

import pytest

PARTS = Path(__file__).resolve().parents[3] / 'scripts' / 'setup'


@pytest.mark.parametrize('has_tf2, prefixes, built', [
    (True, ['venv', 'ros'], False), (False, ['venv', 'ros'], True), (True, ['venv'], True),
    (True, [], True)])
def test_tf2_msgs_is_built_where_ros_lacks_it(tmp_path, has_tf2, prefixes, built):
    """A sourced ROS would get a second tf2_msgs over its own, or ROS from wheels none."""
    for name, has in (('venv', True), ('ros', has_tf2)):
        share = tmp_path / name / 'share' / ('tf2_msgs' if has else 'std_msgs')
        share.mkdir(parents=True)
    searched = ':'.join(str(tmp_path / name) for name in prefixes)
    done = subprocess.run(
        ['bash', '-euc', f'. {shlex.quote(str(PARTS))}/interfaces.sh; '
         'build_package() { echo "$1"; }; build_interfaces'],
        env={'PATH': '/usr/bin:/bin', 'venv': str(tmp_path / 'venv'),
             'AMENT_PREFIX_PATH': searched},
        capture_output=True, text=True, check=True)
    assert done.stdout.split() == (
        ['scripts/setup/tf2_msgs'] if built else []) + ['cloth_sim_interfaces']
