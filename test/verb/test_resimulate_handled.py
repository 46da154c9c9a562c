# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Recorded runs of a real node whose grasps and colliders were moved, made again."""

from collections.abc import Iterator
import math
from pathlib import Path

from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_interfaces.srv import Release
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.verb.main import main
from cloth_under_test import ClothUnderTest
from cloth_under_test import HANDLED
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose
from geometry_msgs.msg import PoseStamped
from geometry_msgs.msg import Quaternion
from graph_client import GraphClient
from made_again import assert_same
from node_process import NodeProcess
import pytest
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

NODE = '/again/cloth_sim'
CORNER = Pose(position=Point(x=-0.45, y=-0.35, z=1.0))


@pytest.fixture(scope='module')
def handled(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ClothUnderTest]:
    """Start a node with two colliders, and listen to it."""
    values = {**HANDLED, 'start_paused': True}
    with GraphClient() as client:
        with NodeProcess(tmp_path_factory.mktemp('again'), values, '-r', '__ns:=/again'):
            yield ClothUnderTest(client, values, NODE)


@pytest.fixture
def cloth(handled: ClothUnderTest) -> ClothUnderTest:
    """Bring the node back to its start, paused."""
    handled.restore()
    return handled


def turned(x, y, z, angle):
    """Return a pose turned by ``angle`` [rad], by a quaternion that is not of length 1."""
    return Pose(
        position=Point(x=x, y=y, z=z),
        orientation=Quaternion(x=2.0 * math.sin(0.5 * angle), w=2.0 * math.cos(0.5 * angle)))


def publisher_of(cloth, topic):
    """Return a publisher of a stream that the node listens to."""
    publisher = cloth.client.node.create_publisher(PoseStamped, f'{cloth.name}/{topic}', 100)
    cloth.client.spin_until(publisher.get_subscription_count, f'the node listens to {topic}')
    return publisher


def test_services_and_streams_are_done_again(cloth, capsys):
    """A recorded run with a robot in it could not be made again: a move would lack, or differ."""
    path = Path(cloth.call(StartRecording, 'start_recording').path)
    balls = publisher_of(cloth, 'colliders/ball/pose')
    assert cloth.call(
        Grasp, 'grasp', name='hand', pose=CORNER, radius=0.12, max_force=50.0).success
    hands = publisher_of(cloth, 'grasps/hand/target')
    cloth.call(
        MoveFrame, 'move_collider', name='floor', pose=turned(0.0, 0.0, 0.3, 0.2), speed=0.21)
    for number in range(12):
        angle = 0.05 * number
        balls.publish(PoseStamped(pose=turned(0.01 * number, 0.003, 0.88, -angle)))
        hands.publish(PoseStamped(pose=turned(-0.45, -0.35, 1.0 + 0.01 * number, angle)))
        cloth.client.spin_until(
            lambda: len(cloth['inputs/grasp_target']) == number + 1, 'the target is taken')
        assert cloth.call(Step, 'step', steps=7).success
    cloth.call(MoveFrame, 'move_grasp', name='hand', pose=CORNER, keep_orientation=True)
    cloth.call(Step, 'step', steps=11)
    assert cloth.call(Release, 'release', name='hand').success
    cloth.call(Step, 'step', steps=20)
    cloth.call(Trigger, 'reset')
    cloth.call(Step, 'step', steps=5)
    assert cloth.call(Trigger, 'stop_recording').success
    assert main(['resimulate', str(path), '--node', cloth.name]) == 0
    assert capsys.readouterr().out.splitlines() == ['17 of 17 frames bitwise identical']
    for publisher in (balls, hands):
        cloth.client.node.destroy_publisher(publisher)


@pytest.mark.parametrize('mode, factor', [
    pytest.param('mass_spring', 0.0, marks=pytest.mark.long), ('constraint', 1.0),
    pytest.param('adaptive', 0.0, marks=pytest.mark.long)])
def test_a_running_node_is_made_again(cloth, mode, factor):
    """What comes while the wall clock decides when would come at another step."""
    cloth.set_parameters(mode=mode, real_time_factor=factor)
    path = Path(cloth.call(StartRecording, 'start_recording').path)
    balls = publisher_of(cloth, 'colliders/ball/pose')
    cloth.call(SetBool, 'pause', data=False)
    for number in range(40):
        balls.publish(PoseStamped(pose=turned(0.1 * math.sin(0.3 * number), 0.0, 0.88, 0.0)))
        if number % 10 == 0:
            cloth.call(
                Grasp, 'grasp', name='hand', pose=CORNER, radius=1.0, max_force=3.0 + number)
        if number % 10 in (1, 4):
            cloth.call(
                MoveFrame, 'move_grasp', name='hand', pose=turned(-0.4, -0.3, 0.9, 0.1 * number))
        if number % 10 == 8:
            cloth.call(Release, 'release')
        cloth.client.spin_for(0.01)
    cloth.call(SetBool, 'pause', data=True)
    cloth.call(Trigger, 'stop_recording')
    cloth.client.spin_until(lambda: len(cloth['inputs/collider_target']) == 40, 'all are taken')
    assert_same(path, node=cloth.name)
    cloth.client.node.destroy_publisher(balls)
