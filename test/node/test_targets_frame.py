# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Grasps and colliders that are moved by service and by streams of poses."""

from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_interfaces.srv import Release
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.node.targets import Intervals
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose
from geometry_msgs.msg import PoseStamped
from geometry_msgs.msg import Quaternion
import pytest
from std_msgs.msg import Header

NAN, INF = float('nan'), float('inf')
UP = Pose(position=Point(z=0.95))
NO_TURN = Quaternion(x=0.0, y=0.0, z=0.0, w=0.0)
BAD_POSES = {
    'no rotation at all': (Pose(orientation=NO_TURN), 'has no direction'),
    'a rotation NaN': (Pose(orientation=Quaternion(w=NAN)), '4 finite numbers'),
    'a place NaN': (Pose(position=Point(y=NAN)), '3 finite numbers'),
    'an infinite place': (Pose(position=Point(y=-INF)), '3 finite numbers'),
    'a place far away': (Pose(position=Point(y=1e7)), 'at most 100000 m'),
}
BAD = {
    **{case: ({'pose': pose}, reason) for case, (pose, reason) in BAD_POSES.items()},
    'a collider that is not there': ({'name': 'bal'}, 'those of the scene, ball, floor'),
    'an absurd speed': ({'speed': 1e9}, 'the speed of ball must be from 1e-06 to 1000 m/s'),
    'a negative speed': ({'speed': -1.0}, 'the speed of ball must be from 1e-06'),
    'a speed NaN': ({'speed': NAN}, 'the speed of ball must be from 1e-06'),
    'an absurd rotation': ({'angular_speed': INF}, 'the angular_speed of ball must be from'),
}


def test_moves_a_collider(handled, twin):
    """A collider would go elsewhere, at another speed or without turning, or not be recorded."""
    turned = Pose(position=Point(x=0.1, z=0.95), orientation=Quaternion(y=0.6, w=0.8))
    response = handled.call(
        MoveFrame, 'move_collider', name='ball', pose=turned, speed=0.3, angular_speed=2.0)
    path = twin.move_collider(
        'ball', (0.1, 0.0, 0.95), (0.0, 0.6, 0.0, 0.8), speed=0.3, angular_speed=2.0)
    assert (response.success, response.arrival) == (True, path.arrival)
    assert response.message.startswith('collider ball moves to (0.1, 0, 0.95) and arrives at')
    told = handled.wait_for('inputs/collider_target')
    assert (told.name, told.pose, told.speed, told.angular_speed) == ('ball', turned, 0.3, 2.0)
    assert handled.call(Step, 'step', steps=120).success
    twin.step(120)
    assert handled.frame(120).tobytes() == twin.snapshot().records.tobytes()


def test_keeps_the_orientation_when_asked(handled):
    """A request without a rotation in mind would turn the collider back."""
    handled.call(
        MoveFrame, 'move_collider', name='floor', pose=Pose(position=Point(z=0.1)),
        keep_orientation=True)
    assert handled.wait_for('inputs/collider_target').keep_orientation


@pytest.mark.parametrize('case', BAD)
def test_refuses_nonsense(handled, case):
    """A bad target would be taken, and throw the cloth."""
    change, reason = BAD[case]
    response = handled.call(
        MoveFrame, 'move_collider', **{'name': 'ball', 'pose': UP, **change})
    assert not response.success
    assert reason in response.message and len(response.message.splitlines()) == 1
    assert not handled['inputs/collider_target']


def test_a_stream_moves_a_collider_at_its_own_pace(handled, twin):
    """A streamed body would lag behind its stream, jump, or follow foreign or bad poses."""
    topic = f'{handled.name}/colliders/ball/pose'
    publisher = handled.client.node.create_publisher(PoseStamped, topic, 100)
    handled.client.spin_until(publisher.get_subscription_count, 'the node listens')
    for pose, _ in BAD_POSES.values():
        publisher.publish(PoseStamped(pose=pose))
    publisher.publish(PoseStamped(header=Header(frame_id='tool0'), pose=UP))
    for number in range(8):
        x = 0.01 * number
        publisher.publish(PoseStamped(
            header=Header(frame_id='world' if number % 2 else ''),
            pose=Pose(position=Point(x=x, z=0.9))))
        handled.client.spin_until(
            lambda: len(handled['inputs/collider_target']) == number + 1, 'the pose is taken')
        told = handled['inputs/collider_target'][number]
        twin.move_collider(
            'ball', (x, 0.0, 0.9), (0.0, 0.0, 0.0, 1.0), told.speed, told.angular_speed)
        assert handled.call(Step, 'step', steps=10).success
        twin.step(10)
    speeds = [told.speed for told in handled['inputs/collider_target']]
    # It sets off at motion.speed; then 1 cm in the 0.05 s between two poses is 0.2 m/s.
    assert speeds[0] == 0.5 and speeds[3:] == pytest.approx([0.2] * 5, rel=1e-9)
    assert handled.frame(80).tobytes() == twin.snapshot().records.tobytes()
    handled.client.node.destroy_publisher(publisher)


def test_a_stream_does_not_throw(handled):
    """A pose with a slip of the pen would move a body at any speed."""
    topic = f'{handled.name}/colliders/ball/pose'
    publisher = handled.client.node.create_publisher(PoseStamped, topic, 100)
    handled.client.spin_until(publisher.get_subscription_count, 'the node listens')
    for number in range(2):
        publisher.publish(PoseStamped(pose=Pose(
            position=Point(z=0.85 + 100.0 * number), orientation=Quaternion(x=float(number)))))
        handled.client.spin_until(
            lambda: len(handled['inputs/collider_target']) == number + 1, 'the pose is taken')
        assert handled.call(Step, 'step', steps=1).success
    assert handled['inputs/collider_target'][1].speed == 0.5
    assert handled['inputs/collider_target'][1].angular_speed == 1.5
    handled.client.node.destroy_publisher(publisher)


def test_a_grasp_listens_while_it_holds(handled, twin):
    """A gripper could not be streamed, or its topic would be left behind."""
    topic = f'{handled.name}/grasps/hand/target'
    publisher = handled.client.node.create_publisher(PoseStamped, topic, 100)
    here = Pose(position=Point(x=-0.45, y=-0.35, z=1.0))
    assert handled.call(Grasp, 'grasp', name='hand', pose=here, radius=0.12).success
    twin.grasp('hand', (-0.45, -0.35, 1.0), radius=0.12)
    handled.client.spin_until(publisher.get_subscription_count, 'the grasp listens')
    publisher.publish(PoseStamped(pose=Pose(
        position=Point(x=-0.4, y=-0.35, z=1.1), orientation=Quaternion(z=0.2, w=1.0))))
    handled.wait_for('inputs/grasp_target')
    twin.move_grasp('hand', (-0.4, -0.35, 1.1), (0.0, 0.0, 0.2, 1.0))
    assert handled.call(Step, 'step', steps=60).success
    twin.step(60)
    assert handled.frame(60).tobytes() == twin.snapshot().records.tobytes()
    assert handled.call(Release, 'release', name='hand').success
    handled.client.spin_until(
        lambda: not publisher.get_subscription_count(), 'the topic is given up')
    handled.client.node.destroy_publisher(publisher)


def test_intervals_of_a_stream():
    """A burst of messages, or one after a pause, would have a body jump or creep."""
    intervals = Intervals()
    found = [intervals.before(now) for now in (0.0, 0.05, 0.05, 0.06, 0.5, 0.6, 0.0, 0.01)]
    assert found == pytest.approx([0.0, 0.05, 0.05, 0.01, 0.0, 0.1, 0.0, 0.01])
