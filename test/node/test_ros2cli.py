# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Actions by `ros2 action` and `ros2 service`, where ROS has these commands."""

import os
import re
import shutil
import subprocess

from cloth_sim_interfaces.srv import Grasp
from cloth_under_test import ClothUnderTest
from cloth_under_test import SCENE
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose
from node_process import NodeProcess
from node_process import PATIENCE
import pytest
from std_srvs.srv import SetBool

# Wheels of ROS have no commands; a sourced ROS has.
pytest.importorskip('ros2action')
NAME = '/commanded/cloth_sim'
FAR = 'pose: {position: {x: 9.0, z: 1.0}}, keep_orientation: true'


@pytest.fixture
def moving(client, tmp_path):
    """Let a cloth with a grasped corner run."""
    values = {**SCENE, 'mode': 'mass_spring', 'start_paused': True}
    with NodeProcess(tmp_path, values, '-r', '__ns:=/commanded'):
        cloth = ClothUnderTest(client, values, NAME)
        assert cloth.call(
            Grasp, 'grasp', name='hand',
            pose=Pose(position=Point(x=0.45, y=-0.35, z=1.0))).success
        assert cloth.call(SetBool, 'pause', data=False).success
        yield cloth


def ros2(*arguments):
    """Return the command line."""
    return [shutil.which('ros2'), *arguments]


def send_goal(kind, goal):
    """Return the command line that moves the grasp, or makes steps."""
    return ros2('action', 'send_goal', '--feedback', f'{NAME}/{kind}',
                f'cloth_sim_interfaces/action/{"Step" if kind == "step" else "MoveFrame"}', goal)


def printed(command):
    """Return what a command prints."""
    return subprocess.run(
        command, capture_output=True, text=True, timeout=PATIENCE, check=True).stdout


def test_a_move_tells_its_way_and_its_end(moving):
    """A user at a shell would not see how far a move is, or that it has ended."""
    shown = printed(send_goal(
        'move_grasp', '{name: hand, pose: {position: {x: 0.45, y: -0.35, z: 1.1}}, speed: 0.2}'))
    ways = [float(way) for way in re.findall(r'Feedback:\s+way_left: (\S+)', shown)]
    assert len(ways) > 2 and ways == sorted(ways, reverse=True)
    assert 'code: 0\n' in shown and 'Goal finished with status: SUCCEEDED' in shown


def test_a_move_that_the_cloth_holds_back_has_stalled(moving):
    """A user at a shell would tear the cloth apart."""
    shown = printed(send_goal('move_grasp', f'{{name: hand, {FAR}, speed: 0.5, max_force: 3.0}}'))
    assert 'code: 10\n' in shown and 'Goal finished with status: ABORTED' in shown
    assert 'max_force is 3 N' in shown


@pytest.mark.parametrize(('kind', 'goal'), [
    ('move_grasp', f'{{name: hand, {FAR}, speed: 0.05}}'), ('step', '{steps: 100000}')])
def test_a_goal_is_canceled(moving, tmp_path, kind, goal):
    """A user at a shell could not end what was begun there."""
    if kind == 'step':
        assert moving.call(SetBool, 'pause', data=True).success
    moving.clear()
    with (tmp_path / 'goal').open('w') as out:
        process = subprocess.Popen(send_goal(kind, goal), stdout=out, env={
            **os.environ, 'PYTHONUNBUFFERED': '1'})
    try:
        moving.client.spin_until(
            lambda: process.poll() is not None or 'Feedback' in (tmp_path / 'goal').read_text(),
            'feedback')
        cancel = printed(ros2(
            'service', 'call', f'{NAME}/{kind}/_action/cancel_goal',
            'action_msgs/srv/CancelGoal'))
        assert 'return_code=0' in cancel
        moving.client.spin_until(lambda: process.poll() is not None, 'it ends')
    finally:
        process.kill()
        process.wait()
    shown = (tmp_path / 'goal').read_text()
    assert 'code: 9\n' in shown and 'Goal finished with status: CANCELED' in shown
    if kind == 'move_grasp':
        # Where it stands now, and since when.
        moving.client.spin_until(
            lambda: len(moving['inputs/grasp_target']) > 1, 'where it stops')
        stop = moving['inputs/grasp_target'][-1].header.stamp
        end = float(re.findall(r'sim_time: (\S+)', shown)[-1])
        assert stop.sec + 1e-9 * stop.nanosec == pytest.approx(end, abs=SCENE['dt'])
