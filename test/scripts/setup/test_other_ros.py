# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Keep the folders of another ROS out of the environment."""

from pathlib import Path
import shlex
import subprocess

PARTS = Path(__file__).resolve().parents[3] / 'scripts' / 'setup'


def environment_after_leaving(variables: dict[str, str]) -> dict[str, str]:
    """Return this environment after leave_other_ros."""
    done = subprocess.run(
        ['bash', '-euc', f'. {shlex.quote(str(PARTS))}/other_ros.sh; '
         'leave_other_ros "$(ros_source)"; env -0'],
        env={'PATH': '/usr/bin:/bin', **variables}, capture_output=True, text=True, check=True)
    return dict(entry.split('=', 1) for entry in done.stdout.split('\0') if entry)


def test_another_ros_is_left(tmp_path):
    """The node would load libraries of another ROS and crash; a GPU driver's must stay."""
    humble = tmp_path / 'humble'
    (humble / 'share' / 'ament_index').mkdir(parents=True)
    left = environment_after_leaving({
        'ROS_DISTRO': 'humble',
        'AMENT_PREFIX_PATH': str(humble),
        '_ROS_WHEELS_BOOTSTRAP_COMPLETE': '1',
        'LD_LIBRARY_PATH': f'{humble}/lib:/opt/driver/lib64:{humble}/opt/vendor/lib',
        'PYTHONPATH': f'{humble}/lib/python3.10/site-packages:/home/me/mine:'
                      f'{humble}/local/lib/python3.10/dist-packages',
    })
    assert left['LD_LIBRARY_PATH'] == '/opt/driver/lib64'
    assert left['PYTHONPATH'] == '/home/me/mine'
    for name in ('ROS_DISTRO', 'AMENT_PREFIX_PATH', '_ROS_WHEELS_BOOTSTRAP_COMPLETE'):
        assert name not in left


def test_a_sourced_jazzy_stays(tmp_path):
    """A user's own ROS 2 Jazzy would be replaced by wheels."""
    sourced = {
        'ROS_DISTRO': 'jazzy',
        'AMENT_PREFIX_PATH': str(tmp_path),
        'LD_LIBRARY_PATH': f'{tmp_path}/lib',
        'PYTHONPATH': f'{tmp_path}/lib/python3.12/site-packages',
    }
    assert environment_after_leaving(sourced).items() >= sourced.items()
