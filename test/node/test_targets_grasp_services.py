# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Grasps by service: what is held, moved, released and lost."""

from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_interfaces.srv import Release
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import Step
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose
from geometry_msgs.msg import Quaternion
import pytest
from rcl_interfaces.msg import Log
from std_srvs.srv import Trigger

NAN, INF = float('nan'), float('inf')
# The lower left corner, which is free.
CORNER = Pose(position=Point(x=-0.45, y=-0.35, z=1.0))
NO_TURN = Quaternion(x=0.0, y=0.0, z=0.0, w=0.0)
BAD = {
    'a negative radius': ({'radius': -0.1}, 'radius of grasp hand must be from 0'),
    'a radius NaN': ({'radius': NAN}, 'radius of grasp hand must be from 0'),
    'a negative force': ({'max_force': -1.0}, 'max_force of grasp hand must be from 0'),
    'a radius and a count': ({'radius': 0.1, 'count': 2}, 'give one of them'),
    'no name': ({'name': ''}, 'no name of a grasp'),
    'a name with a slash': ({'name': 'left/hand'}, 'no name of a grasp'),
    'a place NaN': ({'pose': Pose(position=Point(x=NAN))}, '3 finite numbers'),
    'an infinite place': ({'pose': Pose(position=Point(x=INF))}, '3 finite numbers'),
    'no rotation at all': ({'pose': Pose(orientation=NO_TURN)}, 'has no direction'),
    'a rotation NaN': (
        {'pose': Pose(orientation=Quaternion(x=NAN))}, '4 finite numbers'),
    'nothing near': ({'pose': Pose(position=Point(z=3.0))}, 'no free node within'),
}


def grasp_corner(cloth, **fields):
    """Grasp the nodes near the lower left corner."""
    response = cloth.call(
        Grasp, 'grasp', **{'name': 'hand', 'pose': CORNER, 'radius': 0.12, **fields})
    assert response.success, response.message
    return response


def test_holds_moves_and_releases(handled, twin):
    """A grasp would hold other nodes, move them elsewhere, or not let them go."""
    grasp = twin.grasp('hand', (-0.45, -0.35, 1.0), radius=0.12)
    response = grasp_corner(handled)
    assert response.nodes == len(grasp.nodes) == 3
    told = handled.wait_for('inputs/grasp')
    assert (told.name, told.grasped, told.by_force) == ('hand', True, False)
    assert list(zip(told.rows, told.cols)) == list(map(tuple, grasp.nodes.tolist()))
    turned = Pose(
        position=Point(x=-0.4, y=-0.3, z=1.1), orientation=Quaternion(x=0.3, w=1.0))
    moved = handled.call(MoveFrame, 'move_grasp', name='hand', pose=turned, speed=0.4)
    path = twin.move_grasp('hand', (-0.4, -0.3, 1.1), (0.3, 0.0, 0.0, 1.0), speed=0.4)
    assert (moved.success, moved.arrival) == (True, path.arrival)
    target = handled.wait_for('inputs/grasp_target')
    assert (target.name, target.keep_orientation) == ('hand', False)
    assert (target.speed, target.angular_speed) == (0.4, 1.5)
    assert handled.call(Step, 'step', steps=100).success
    twin.step(100)
    assert handled.frame(100).tobytes() == twin.snapshot().records.tobytes()
    handled.clear()
    freed = handled.call(Release, 'release', name='hand')
    twin.release_grasp('hand')
    assert (freed.success, freed.nodes) == (True, 3)
    assert not handled.wait_for('inputs/grasp').grasped
    assert handled.call(Step, 'step', steps=20).success
    twin.step(20)
    assert handled.frame(120).tobytes() == twin.snapshot().records.tobytes()


def test_releases_all(handled):
    """A robot that lets go of everything would have to remember what it holds."""
    grasp_corner(handled)
    other = Pose(position=Point(x=0.45, y=-0.35, z=1.0))
    grasp_corner(handled, name='other', pose=other, radius=0.0, count=1)
    response = handled.call(Release, 'release')
    assert (response.success, response.nodes) == (True, 4)
    assert response.message == '4 nodes of 2 grasps are free'
    assert handled.call(Release, 'release').nodes == 0


@pytest.mark.parametrize('case', BAD)
def test_refuses_nonsense(handled, case):
    """A bad request would hold something, or end the node."""
    change, reason = BAD[case]
    response = handled.call(
        Grasp, 'grasp', **{'name': 'hand', 'pose': CORNER, **change})
    assert not response.success
    assert reason in response.message and len(response.message.splitlines()) == 1
    assert not handled['inputs/grasp']
    assert handled.call(Release, 'release').nodes == 0


def test_refuses_what_is_not_held(handled):
    """A mistyped name would be taken for another grasp, or answered without a way out."""
    for kind, name in ((Release, 'release'), (MoveFrame, 'move_grasp')):
        response = handled.call(kind, name, name='hnad')
        assert not response.success and 'there is no grasp' in response.message
    grasp_corner(handled)
    assert not handled.call(Grasp, 'grasp', name='hand', pose=CORNER).success
    response = handled.call(SetPin, 'set_pin', row=7, col=0, release=True)
    assert not response.success and 'grasp hand holds node (7, 0)' in response.message


def test_a_grasp_that_is_lost_is_told(handled, twin):
    """A robot would continue with an empty gripper and not know."""
    log = handled.client.watch(Log, '/rosout')
    grasp_corner(handled, max_force=0.3)
    handled.call(MoveFrame, 'move_grasp', name='hand', pose=Pose(position=Point(x=-0.9, z=1.2)))
    twin.grasp('hand', (-0.45, -0.35, 1.0), radius=0.12, max_force=0.3)
    twin.move_grasp('hand', (-0.9, 0.0, 1.2), (0.0, 0.0, 0.0, 1.0))
    assert handled.call(Step, 'step', steps=200).success
    twin.step(200)
    assert not twin.grasps
    told = handled.wait_for('inputs/grasp', lambda message: not message.grasped)
    assert (told.name, told.by_force) == ('hand', True)
    assert 0 < handled.steps_of(told) < 200
    handled.client.spin_until(
        lambda: any('grasp hand has lost the cloth' in line.msg for line in log.messages),
        'the warning')
    assert handled.frame(200).tobytes() == twin.snapshot().records.tobytes()


def test_a_reset_lets_go(handled, twin):
    """What was held before a reset would hang in the new run."""
    grasp_corner(handled)
    handled.call(Step, 'step', steps=3)
    handled.call(Trigger, 'reset')
    handled.clear()
    handled.call(Step, 'step', steps=10)
    twin.step(10)
    assert handled.frame(10).tobytes() == twin.snapshot().records.tobytes()
    grasp_corner(handled)
