# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Grasps and colliders that follow frames of tf."""

from itertools import count
from pathlib import Path

from cloth_sim_interfaces.msg import ResultCode
from cloth_sim_interfaces.srv import FollowFrame
from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_interfaces.srv import Release
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.sim.model.pose import Pose
from cloth_under_test import ClothUnderTest
from cloth_under_test import HANDLED
from cloth_under_test import HANDLED_NAME
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose as PoseMessage
from geometry_msgs.msg import PoseStamped
from made_again import assert_same
from node_process import NodeProcess
import pytest
from std_srvs.srv import Trigger
from transform_teller import Teller
from transform_teller import transform

CORNER = PoseMessage(position=Point(x=0.45, y=-0.35, z=1.0))
HAND = 'handled_cloth_sim_grasp_hand'
BALL = 'handled_cloth_sim_collider_ball'
# Each test has frames of its own: tf keeps those of the tests before.
NUMBERS = count()
TURNED = (0.0, 0.0, 0.5 ** 0.5, 0.5 ** 0.5)  # by 90 degrees about z


@pytest.fixture
def teller(handled):
    """Tell the node transforms."""
    teller = Teller(handled)
    yield teller
    teller.close()
    for kind, name in (('grasp', 'hand'), ('collider', 'ball')):
        handled.call(FollowFrame, f'follow_{kind}', name=name)


@pytest.fixture
def tool():
    """Name a frame that no test before has had."""
    return f'tool{next(NUMBERS)}'


def pose_after(cloth, steps, frame):
    """Make ``steps`` steps; return where ``frame`` of the node is then, x y z."""
    cloth.clear()
    answer = cloth.call(Step, 'step', steps=steps)
    assert answer.success
    # Frames come on the way, too.
    found = cloth.client.spin_until(lambda: [
        each.transform for message in cloth['tf'] for each in message.transforms
        if each.child_frame_id == frame
        and seconds_of(each.header.stamp) > answer.sim_time - 1e-6],
        f'the transform of {frame}')[-1]
    place, turn = found.translation, found.rotation
    return (place.x, place.y, place.z), (turn.x, turn.y, turn.z, turn.w)


def seconds_of(stamp):
    """Return a stamp [s]."""
    return stamp.sec + 1e-9 * stamp.nanosec


def grasp(cloth, frame):
    """Grasp the corner, attached to ``frame``."""
    return cloth.call(Grasp, 'grasp', name='hand', pose=CORNER, follow_frame=frame)


def test_a_grasp_goes_where_its_frame_goes(handled, teller, tool):
    """A gripper would need a program that sends its pose again and again."""
    teller.tell(transform(tool, 'world', Pose((0.45, -0.35, 1.1)), 5001.0))
    answer = grasp(handled, tool)
    assert answer.success and answer.message.endswith(f'and follows {tool}')
    # 0.1 m below the frame, and so it stays, on another side once that has turned.
    teller.tell(transform(tool, 'world', Pose((0.45, -0.25, 1.1)), 5001.1))
    place, _ = pose_after(handled, 40, HAND)
    assert place == pytest.approx((0.45, -0.25, 1.0), abs=1e-9)
    teller.tell(transform(tool, 'world', Pose((0.45, -0.25, 1.2), TURNED), 5001.3))
    place, turn = pose_after(handled, 80, HAND)
    assert place == pytest.approx((0.45, -0.25, 1.1), abs=1e-9)
    assert turn == pytest.approx(TURNED, abs=1e-7)


def test_a_collider_follows_below_its_highest_speed(handled, teller, tool):
    """A wrong frame would shoot a body through the cloth."""
    teller.tell(transform(tool, 'world', Pose((0.0, 0.0, 0.0)), 5001.0))
    assert handled.call(
        FollowFrame, 'follow_collider', name='ball', frame=tool, max_speed=0.1).success
    teller.tell(transform(tool, 'world', Pose((0.3, 0.0, 0.0)), 5001.01))
    place, _ = pose_after(handled, 100, BALL)
    assert place == pytest.approx((0.1 * 100 * HANDLED['dt'], 0.0, 0.85), abs=1e-9)
    # Behind, and said so.
    handled.wait_for('diagnostics', lambda array: any(
        'ball are behind their frames' in status.message for status in array.status))
    place, _ = pose_after(handled, 600, BALL)
    assert place == pytest.approx((0.3, 0.0, 0.85), abs=1e-9)


def test_a_late_frame_is_waited_for_and_said(handled, teller, tool):
    """A robot whose driver has died would look as if it stood still."""
    teller.tell(transform(tool, 'world', Pose((0.0, 0.0, 0.0)), 5001.0))
    assert handled.call(FollowFrame, 'follow_collider', name='ball', frame=tool).success
    place, _ = pose_after(handled, 200, BALL)
    assert place == pytest.approx((0.0, 0.0, 0.85), abs=1e-9)
    handled.wait_for('diagnostics', lambda array: any(
        f'{tool} have not come on /tf' in status.message for status in array.status))
    teller.tell(transform(tool, 'world', Pose((0.0, 0.1, 0.0)), 5002.0))
    place, _ = pose_after(handled, 100, BALL)
    assert place == pytest.approx((0.0, 0.1, 0.85), abs=1e-9)


def test_a_frame_that_is_fixed_is_never_late(handled, teller, tool):
    """A gripper on a bench would raise an alarm."""
    teller.tell(transform(tool, 'world', Pose((0.0, 0.0, 0.0))), is_fixed=True)
    assert handled.call(FollowFrame, 'follow_collider', name='ball', frame=tool).success
    pose_after(handled, 200, BALL)
    handled.wait_for('diagnostics', lambda array: any(
        status.message == '1 bodies follow frames of tf' for status in array.status))


def test_what_cannot_be_followed_changes_nothing(handled, teller, tool):
    """A grasp would hold the cloth with no hand to carry it."""
    refused = grasp(handled, 'nowhere')
    assert (refused.success, refused.code) == (False, ResultCode.UNKNOWN_FRAME)
    assert "frame 'nowhere' is not known" in refused.message
    assert not handled.call(Release, 'release', name='hand').success
    for fields, code, reason in (
            ({'name': 'ball', 'frame': 'nowhere'}, ResultCode.UNKNOWN_FRAME, 'is not known'),
            ({'name': 'nobody', 'frame': 'world'}, ResultCode.NOT_FOUND, 'no collider'),
            ({'name': 'ball', 'frame': BALL}, ResultCode.INVALID_VALUE, 'one of this node'),
            ({'name': 'ball', 'frame': 'x', 'max_speed': -1.0}, ResultCode.INVALID_VALUE,
             'max_speed must be'),
            ({'name': 'ball'}, ResultCode.NOT_FOUND, 'follows no frame')):
        refused = handled.call(FollowFrame, 'follow_collider', **fields)
        assert (refused.success, refused.code) == (False, code), refused.message
        assert reason in refused.message


def test_it_is_not_moved_besides(handled, teller, tool):
    """Two programs would pull at one body."""
    teller.tell(transform(tool, 'world', Pose((0.0, 0.0, 0.0)), 5001.0))
    assert handled.call(FollowFrame, 'follow_collider', name='ball', frame=tool).success
    refused = handled.call(MoveFrame, 'move_collider', name='ball', pose=PoseMessage())
    assert (refused.success, refused.code) == (False, ResultCode.WRONG_STATE)
    assert '~/follow_collider' in refused.message
    stream = handled.client.node.create_publisher(
        PoseStamped, f'{HANDLED_NAME}/colliders/ball/pose', 1)
    handled.client.spin_until(stream.get_subscription_count, 'the node listens')
    stream.publish(PoseStamped())
    handled.client.spin_for(0.2)
    place, _ = pose_after(handled, 20, BALL)
    assert place == pytest.approx((0.0, 0.0, 0.85), abs=1e-9)
    handled.client.node.destroy_publisher(stream)
    # No longer attached, it can be.
    assert handled.call(FollowFrame, 'follow_collider', name='ball').success
    assert handled.call(MoveFrame, 'move_collider', name='ball', pose=PoseMessage()).success


def test_a_rerun_needs_no_tf(handled, teller, tool):
    """What a robot did with the cloth could not be made again without the robot."""
    path = Path(handled.call(StartRecording, 'start_recording', name='').path)
    teller.tell(transform(tool, 'world', Pose((0.45, -0.35, 1.0)), 5001.0))
    assert grasp(handled, tool).success
    for number in range(1, 6):
        teller.tell(transform(tool, 'world', Pose((0.45, -0.35, 1.0 + 0.02 * number)),
                              5001.0 + 0.1 * number))
        pose_after(handled, 20, HAND)
    assert handled.call(Trigger, 'stop_recording').success
    assert_same(path, node=HANDLED_NAME)


def test_after_a_reset_a_grasp_is_gone_and_a_collider_follows(handled, teller, tool):
    """A hand would hold a cloth that it never took, or a body stand beside its robot."""
    teller.tell(transform(tool, 'world', Pose((0.0, 0.0, 0.0)), 5001.0))
    assert handled.call(FollowFrame, 'follow_collider', name='ball', frame=tool).success
    assert grasp(handled, tool).success
    assert handled.call(Trigger, 'reset').success
    assert not handled.call(FollowFrame, 'follow_grasp', name='hand').success
    teller.tell(transform(tool, 'world', Pose((0.1, 0.0, 0.0)), 5001.2))
    place, _ = pose_after(handled, 100, BALL)
    assert place == pytest.approx((0.1, 0.0, 0.85), abs=1e-9)


def test_bodies_of_the_scene_follow_from_the_start(client, tmp_path):
    """A scene would need a program beside it to attach its grippers."""
    values = {
        **HANDLED, 'start_paused': True, 'grasps.start': [0.0], 'grasps.name': ['left'],
        'grasps.position': [0.45, -0.35, 1.0],
        'tf.follow': ['left=finger', 'ball=finger'], 'tf.follow_speed': 1.0}
    with NodeProcess(tmp_path, values, '-r', '__ns:=/scene_follows'):
        cloth = ClothUnderTest(client, values, '/scene_follows/cloth_sim')
        cloth.wait_for('diagnostics', lambda array: any(
            'finger have not come on /tf' in status.message for status in array.status))
        teller = Teller(cloth)
        teller.tell(transform('finger', 'world', Pose((0.0, 0.0, 0.0)), 5001.0))
        assert cloth.call(Step, 'step', steps=2).success
        teller.tell(transform('finger', 'world', Pose((0.0, 0.0, 0.1)), 5001.2))
        for frame, place in (('grasp_left', (0.45, -0.35, 1.1)),
                             ('collider_ball', (0.0, 0.0, 0.95))):
            found, _ = pose_after(cloth, 60, f'scene_follows_cloth_sim_{frame}')
            assert found == pytest.approx(place, abs=1e-9)
        teller.close()
