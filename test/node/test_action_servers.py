# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Moves and steps as actions: feedback on the way, an end on request, and one where it stalls."""

from action_msgs.msg import GoalStatus
from action_msgs.srv import CancelGoal
from cloth_sim_interfaces.action import MoveFrame
from cloth_sim_interfaces.action import Step as StepAction
from cloth_sim_interfaces.msg import ResultCode
from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame as MoveService
from cloth_sim_interfaces.srv import Release
from cloth_sim_interfaces.srv import Step
from cloth_under_test import ClothUnderTest
from cloth_under_test import HANDLED
from cloth_under_test import HANDLED_NAME
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose
from geometry_msgs.msg import Quaternion
from node_process import NodeProcess
import pytest
from rclpy.action import ActionClient
from std_msgs.msg import Header
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

CORNER = Pose(position=Point(x=0.45, y=-0.35, z=1.0))


class Goal:
    """A goal that was sent, what is heard of it, and its end."""

    opened = []

    def __init__(self, cloth, kind, action, /, **fields):
        """Send it, and wait until it is accepted."""
        self._client = cloth.client
        self.feedback = []
        self._server = ActionClient(cloth.client.node, kind, f'{cloth.name}/{action}')
        self.opened.append(self._server)
        self._client.spin_until(self._server.server_is_ready, f'{action} is served')
        # Its service for results is found last.
        self._client.spin_for(0.1)
        accepted = self._server.send_goal_async(
            kind.Goal(**fields), lambda message: self.feedback.append(message.feedback))
        self._client.spin_until(accepted.done, 'the goal is accepted')
        self._handle = accepted.result()
        assert self._handle.accepted

    def hear(self, count=2):
        """Wait for feedback."""
        self._client.spin_until(lambda: len(self.feedback) >= count, 'feedback')
        return self.feedback[-1]

    def cancel(self):
        """Ask for its end; return the code of the answer, and how many goals end."""
        future = self._handle.cancel_goal_async()
        self._client.spin_until(future.done, 'an answer')
        answer = future.result()
        return answer.return_code, len(answer.goals_canceling)

    def end(self):
        """Return its state and its result."""
        # Not before: with the result, rclpy drops the feedback that waits.
        end = self._handle.get_result_async()
        self._client.spin_until(end.done, 'the end')
        return end.result().status, end.result().result


@pytest.fixture(autouse=True)
def closed():
    """Take the clients of actions back."""
    yield
    while Goal.opened:
        Goal.opened.pop().destroy()


@pytest.fixture
def moving(handled):
    """Let the cloth with a grasped corner run."""
    assert handled.call(Grasp, 'grasp', name='hand', pose=CORNER).success
    assert handled.call(SetBool, 'pause', data=False).success
    yield handled
    handled.call(SetBool, 'pause', data=True)


MOVES = {
    'move_grasp': {'name': 'hand', 'pose': Pose(position=Point(x=0.45, y=-0.35, z=1.1))},
    'move_collider': {'name': 'ball', 'pose': Pose(position=Point(x=0.0, y=0.0, z=0.65))},
    'move_pin': {'row': 0, 'col': 9, 'pose': Pose(position=Point(x=0.45, y=0.35, z=1.1))},
}
FAR = {
    name: {**fields, 'pose': Pose(position=Point(x=9.0, y=0.0, z=1.0)), 'keep_orientation': True}
    for name, fields in MOVES.items()}


@pytest.mark.parametrize('name', MOVES)
def test_a_move_tells_its_way_and_its_end(moving, name):
    """A program could not tell how long it has to wait, or that it can go on."""
    goal = Goal(moving, MoveFrame, name, speed=0.3, keep_orientation=True, **MOVES[name])
    goal.hear()
    status, result = goal.end()
    assert status == GoalStatus.STATUS_SUCCEEDED, result.message
    assert (result.success, result.code) == (True, ResultCode.OK)
    assert result.way_left <= 1e-5 and 'has arrived' in result.message
    ways = [feedback.way_left for feedback in goal.feedback]
    assert ways == sorted(ways, reverse=True) and ways[0] > ways[-1] > 0.0
    if name == 'move_pin':
        assert any(feedback.force > 0.0 for feedback in goal.feedback)


def test_a_turn_tells_its_angle(moving):
    """A body that only turns would seem to have arrived at once."""
    half = 0.5 ** 0.5
    goal = Goal(moving, MoveFrame, 'move_collider', name='ball', angular_speed=3.0, pose=Pose(
        position=Point(z=0.85), orientation=Quaternion(z=half, w=half)))
    assert goal.hear().angle_left > 0.0
    status, result = goal.end()
    assert status == GoalStatus.STATUS_SUCCEEDED, result.message
    assert result.angle_left == pytest.approx(0.0, abs=1e-7)


@pytest.mark.parametrize('name', FAR)
def test_a_canceled_move_stops_there(moving, name):
    """A body would go on although nobody wants that any more."""
    goal = Goal(moving, MoveFrame, name, speed=0.2, **FAR[name])
    goal.hear()
    assert goal.cancel() == (CancelGoal.Response.ERROR_NONE, 1)
    status, result = goal.end()
    assert status == GoalStatus.STATUS_CANCELED, result.message
    assert (result.success, result.code) == (False, ResultCode.CANCELED)
    # Within a step: where it is now is where it was then.
    key = {'move_pin': 'inputs/pin_target', 'move_grasp': 'inputs/grasp_target',
           'move_collider': 'inputs/collider_target'}[name]
    stop = moving.wait_for(key, lambda message: moving[key][0] is not message)
    assert stop.header.stamp.sec + 1e-9 * stop.header.stamp.nanosec == pytest.approx(
        result.sim_time, abs=HANDLED['dt'] + 1e-6)
    # What has ended can not be canceled, and nothing changes.
    count = len(moving[key])
    assert goal.cancel() == (CancelGoal.Response.ERROR_GOAL_TERMINATED, 0)
    assert len(moving[key]) == count


@pytest.mark.parametrize('name', ['move_pin', 'move_grasp'])
def test_a_move_stops_where_the_cloth_pulls_too_hard(moving, name):
    """A gripper would tear the cloth apart, or a program wait for ever."""
    goal = Goal(moving, MoveFrame, name, speed=0.5, max_force=3.0, **FAR[name])
    status, result = goal.end()
    assert status == GoalStatus.STATUS_ABORTED
    assert result.code == ResultCode.STALLED, result.message
    assert result.force >= 3.0 and result.way_left > 1.0
    assert 'max_force is 3 N' in result.message


def test_a_pin_that_waits_has_stalled(client, tmp_path):
    """A program would wait for a pin that the cloth holds back."""
    values = {**HANDLED, 'pin.max_force': 0.5}
    with NodeProcess(tmp_path, values, '-r', '__ns:=/stalls'):
        cloth = ClothUnderTest(client, values, '/stalls/cloth_sim')
        status, result = Goal(
            cloth, MoveFrame, 'move_pin', speed=0.5, **FAR['move_pin']).end()
        assert status == GoalStatus.STATUS_ABORTED
        assert result.code == ResultCode.STALLED, result.message
        assert 'pin.max_force' in result.message


def test_what_else_ends_a_move(moving):
    """A program would wait for a move that nobody makes any more."""
    for end, code in (
            (lambda: moving.call(MoveService, 'move_grasp', name='hand', pose=CORNER),
             ResultCode.INTERRUPTED),
            (lambda: moving.call(Release, 'release', name='hand'), ResultCode.NOT_FOUND),
            (lambda: moving.call(Trigger, 'reset'), ResultCode.INTERRUPTED)):
        # The last move may have taken the corner away, and one that is free falls out of reach.
        assert moving.call(SetBool, 'pause', data=True).success
        assert moving.call(Trigger, 'reset').success
        assert moving.call(Grasp, 'grasp', name='hand', pose=CORNER).success
        assert moving.call(SetBool, 'pause', data=False).success
        goal = Goal(moving, MoveFrame, 'move_grasp', speed=0.1, **FAR['move_grasp'])
        goal.hear()
        assert end().success
        status, result = goal.end()
        assert status == GoalStatus.STATUS_ABORTED
        assert (result.success, result.code) == (False, code), result.message


@pytest.mark.parametrize(('name', 'fields', 'code'), [
    ('move_grasp', {'name': 'nobody'}, ResultCode.NOT_FOUND),
    ('move_pin', {'row': 3, 'col': 3}, ResultCode.NOT_FOUND),
    ('move_collider', {'name': 'ball', 'header': Header(frame_id='nowhere')},
     ResultCode.UNKNOWN_FRAME),
    ('move_collider', {'name': 'ball', 'max_force': -1.0}, ResultCode.INVALID_VALUE)])
def test_a_goal_that_makes_no_sense_ends_at_once(handled, name, fields, code):
    """A program would get no reason, or a time that is not that of its end."""
    assert handled.call(Step, 'step', steps=2).success
    status, result = Goal(handled, MoveFrame, name, **fields).end()
    assert status == GoalStatus.STATUS_ABORTED
    assert (result.success, result.code) == (False, code), result.message
    assert result.message and result.sim_time == pytest.approx(2 * HANDLED['dt'])


def test_steps_tell_how_far_they_are(handled):
    """A program that has asked for an hour of simulated time would hear nothing for long."""
    goal = Goal(handled, StepAction, 'step', steps=600)
    assert 0 < goal.hear().steps < 600
    status, result = goal.end()
    assert status == GoalStatus.STATUS_SUCCEEDED, result.message
    assert (result.success, result.code, result.steps) == (True, ResultCode.OK, 600)
    assert result.sim_time == pytest.approx(600 * HANDLED['dt'])


def test_steps_can_be_canceled(handled):
    """Steps that nobody wants any more would keep the cloth busy."""
    goal = Goal(handled, StepAction, 'step', steps=100_000)
    goal.hear()
    # Another caller is refused, and its end is not that of the first.
    refused = handled.call(Step, 'step', steps=1)
    assert (refused.success, refused.code) == (False, ResultCode.WRONG_STATE)
    status, result = Goal(handled, StepAction, 'step', steps=1).end()
    assert (status, result.code) == (GoalStatus.STATUS_ABORTED, ResultCode.WRONG_STATE)
    assert goal.cancel() == (CancelGoal.Response.ERROR_NONE, 1)
    status, result = goal.end()
    assert status == GoalStatus.STATUS_CANCELED, result.message
    assert (result.success, result.code) == (False, ResultCode.CANCELED)
    assert 0 < result.steps < 100_000
    assert handled.call(Step, 'step', steps=1).success
    handled.wait_for('stats', lambda stats: stats.steps == result.steps + 1)


def test_steps_end_with_a_pause(handled):
    """A program could not tell that somebody else has stopped it."""
    goal = Goal(handled, StepAction, 'step', steps=100_000)
    goal.hear()
    assert handled.call(SetBool, 'pause', data=True).success
    status, result = goal.end()
    assert (status, result.code) == (GoalStatus.STATUS_ABORTED, ResultCode.INTERRUPTED)
    assert HANDLED_NAME and '~/pause ended the steps' in result.message
