# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.


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
