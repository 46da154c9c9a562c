# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which messages the set-up builds."""

from pathlib import Path
import shlex
import subprocess

import pytest

PARTS = Path(__file__).resolve().parents[3] / 'scripts' / 'setup'


@pytest.mark.parametrize('has_them, prefixes, built', [
    (True, ['venv', 'ros'], False), (False, ['venv', 'ros'], True), (True, ['venv'], True),
    (True, [], True)])
def test_messages_are_built_where_ros_lacks_them(tmp_path, has_them, prefixes, built):
    """A sourced ROS would get a second one over its own, or ROS from wheels none."""
    for name, has in (('venv', True), ('ros', has_them)):
        for package in ('tf2_msgs', 'simulation_interfaces'):
            share = tmp_path / name / 'share' / (package if has else 'std_msgs')
            share.mkdir(parents=True, exist_ok=True)
    searched = ':'.join(str(tmp_path / name) for name in prefixes)
    done = subprocess.run(
        ['bash', '-euc', f'. {shlex.quote(str(PARTS))}/interfaces.sh; '
         'install_interfaces() { printf "%s\\n" "$@"; }; build_interfaces'],
        env={'PATH': '/usr/bin:/bin', 'venv': str(tmp_path / 'venv'), 'with_cpp': 'no',
             'stamps': str(tmp_path / 'venv' / '.setup'),
             'AMENT_PREFIX_PATH': searched},
        capture_output=True, text=True, check=True)
    assert done.stdout.split() == ([
        'scripts/setup/tf2_msgs', 'scripts/setup/simulation_interfaces'] if built else []) + [
        'cloth_sim_interfaces']
