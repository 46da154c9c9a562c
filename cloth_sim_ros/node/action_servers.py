# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The actions: moves and steps with feedback, that can be canceled."""

from collections.abc import Callable
from functools import partial
import time
from typing import Any

from cloth_sim_interfaces.action import MoveFrame
from cloth_sim_interfaces.action import Step
from cloth_sim_interfaces.msg import ResultCode
from cloth_sim_ros.node.device_thread import DeviceThread
from cloth_sim_ros.node.followers import Followers
from cloth_sim_ros.node.guarded_node import GuardedNode
from cloth_sim_ros.node.input_frames import InputFrames
from cloth_sim_ros.node.motions import COLLIDER
from cloth_sim_ros.node.motions import FEEDBACK_PERIOD
from cloth_sim_ros.node.motions import GRASP
from cloth_sim_ros.node.motions import Motion
from cloth_sim_ros.node.motions import Motions
from cloth_sim_ros.node.motions import PIN
from cloth_sim_ros.node.motions import Progress
from cloth_sim_ros.node.result_codes import CanceledError
from cloth_sim_ros.node.result_codes import code_of
from cloth_sim_ros.node.run_loop import RunLoop
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.simulation import Simulation
from rclpy.action import ActionServer
from rclpy.action import CancelResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.callback_groups import ReentrantCallbackGroup

Answer = Callable[[Any], None]


class Actions:
    """
    What all of them share.

    :ivar stops: by the number of the goal: what ends it, called on the device thread
    :param device: carries out what goals ask for
    """

    def __init__(self, node: GuardedNode, device: DeviceThread) -> None:
        """Serve none yet."""
        self._node = node
        self._device = device
        self.stops: dict[bytes, Callable[[], object]] = {}

    def serve(self, kind: type, name: str, begin: Callable[..., Any]) -> None:
        """
        Serve the action ``name``.

        :param begin: is given the handle of a goal, its result, and what to call with a text or an
            exception when it has ended; called on the device thread
        """
        ActionServer(
            self._node, kind, self._node.resolve_service_name(name),
            execute_callback=partial(self._execute, kind, name, begin),
            cancel_callback=self._on_cancel, callback_group=ReentrantCallbackGroup())

    def note_end(self, result: Any, message: str, error: Exception | None) -> None:
        """Write how it has ended into ``result``; None for no error."""
        result.success, result.message = error is None, message
        result.code = ResultCode.OK if error is None else code_of(error)

    def publish(self, handle: ServerGoalHandle, feedback: Any) -> None:
        """Send ``feedback``; called on the device thread."""
        def publish() -> None:
            if handle.is_active:
                handle.publish_feedback(feedback)

        self._device.emit(publish, 'a feedback')

    async def _execute(
            self, kind: Any, name: str, begin: Callable[..., Any],
            handle: ServerGoalHandle) -> Any:
        result = kind.Result()
        try:
            text = await self._device.ask_later(
                lambda answer: begin(handle, result, answer))
            self.note_end(result, text, None)
            handle.succeed()
        except ClothSimError as error:
            self.note_end(result, str(error), error)
            if isinstance(error, CanceledError) and handle.is_cancel_requested:
                handle.canceled()
            else:
                handle.abort()
        except Exception as error:
            if not self._node.context.ok():
                raise
            self.note_end(result, self._node.faults.note(error, name), error)
            handle.abort()
        finally:
            self.stops.pop(handle_number(handle), None)
        return result

    def _on_cancel(self, handle: ServerGoalHandle) -> CancelResponse:
        number = handle_number(handle)

        def stop() -> None:
            # What has ended meanwhile has none.
            self.stops.get(number, _do_nothing)()

        self._device.post(stop)
        return CancelResponse.ACCEPT


class Steps:
    """
    Make steps for a goal; used on the device thread.

    :param changed: called when the run state has changed
    """

    def __init__(
            self, simulation: Simulation, run_loop: RunLoop, changed: Callable[[], None]) -> None:
        """Begin with no goal."""
        self._simulation = simulation
        self._run_loop = run_loop
        self._changed = changed
        # Reports the progress of the present goal.
        self._look: Callable[[], None] | None = None

    def look(self) -> bool:
        """Publish how far the steps are; return whether any are requested."""
        if self._look is None:
            return False
        self._look()
        return True

    def begin(
            self, steps: int, feedback: Callable[[int, float], object],
            end: Callable[[Exception | None, int, float], object]) -> Callable[[], object]:
        """
        Begin ``steps`` steps, and return what cancels them.

        :param feedback: is given the steps made and the time [s], now and then
        :param end: is given None or why they were not all made, the steps made and the time [s]
        """
        simulation, run_loop = self._simulation, self._run_loop
        first, before, told = simulation.steps, run_loop.run_state, time.monotonic()

        def made() -> int:
            # After a reset the count starts again.
            return max(simulation.steps - first, 0)

        def done(error: Exception | None) -> None:
            self._look = None
            if run_loop.run_state != before:
                self._changed()
            end(error, made(), simulation.time)

        def look() -> None:
            nonlocal told
            if time.monotonic() - told >= FEEDBACK_PERIOD:
                told = time.monotonic()
                feedback(made(), simulation.time)

        run_loop.step(steps, done)
        self._look = look
        return lambda: run_loop.cancel_steps(done)


class MoveActions(Actions):
    """
    Serve ~/move_pin, ~/move_grasp and ~/move_collider as actions.

    :param frames: says what headers mean
    :param followers: has what follows a frame
    :param motions: looks after the moves
    """

    def __init__(
            self, node: GuardedNode, device: DeviceThread, simulation: Simulation,
            frames: InputFrames, followers: Followers, motions: Motions) -> None:
        """Make the servers."""
        super().__init__(node, device)
        self._simulation = simulation
        self._frames = frames
        self._followers = followers
        self._motions = motions
        for kind in (PIN, GRASP, COLLIDER):
            self.serve(MoveFrame, f'~/move_{kind}', partial(self._begin, kind))

    def _begin(
            self, kind: str, handle: ServerGoalHandle, result: MoveFrame.Result,
            answer: Answer) -> None:
        goal: MoveFrame.Goal = handle.request
        result.sim_time = self._simulation.time
        if not 0.0 <= goal.max_force < float('inf'):
            raise ClothSimError(
                f'max_force must be finite and 0 N or more, got {goal.max_force:g} N: give 0 for '
                'none')
        path = self._move(kind, goal)
        name: Any = (goal.row, goal.col) if kind == PIN else goal.name

        def feedback(progress: Progress) -> None:
            self.publish(handle, _filled(MoveFrame.Feedback(), progress))

        def end(error: Exception | None, progress: Progress) -> None:
            _filled(result, progress)
            answer(error if error is not None else f'{motion.title} has arrived')

        motion: Motion = self._motions.begin(
            kind, name, path, goal.max_force, feedback, end)
        self.stops[handle_number(handle)] = lambda: self._motions.cancel(motion)

    def _move(self, kind: str, goal: MoveFrame.Goal) -> Any:
        given = self._frames.given(goal.header)
        target = given.point(goal.pose.position)
        if kind == PIN:
            return self._simulation.move_pin(goal.row, goal.col, target, goal.speed or None)
        self._followers.check_free(kind, goal.name)
        move = self._simulation.move_grasp if kind == GRASP else self._simulation.move_collider
        return move(
            goal.name, target,
            None if goal.keep_orientation else given.orientation(goal.pose.orientation),
            goal.speed or None, goal.angular_speed or None)


class StepAction(Actions):
    """
    Serve ~/step as an action.

    :param changed: called on the device thread when the run state has changed
    """

    def __init__(
            self, node: GuardedNode, device: DeviceThread, simulation: Simulation,
            run_loop: RunLoop, changed: Callable[[], None]) -> None:
        """Make the server."""
        super().__init__(node, device)
        self._simulation = simulation
        self._steps = Steps(simulation, run_loop, changed)
        self.look = self._steps.look
        self.serve(Step, '~/step', self._begin)

    def _begin(self, handle: ServerGoalHandle, result: Step.Result, answer: Answer) -> None:
        steps = handle.request.steps
        result.sim_time = self._simulation.time

        def feedback(made: int, now: float) -> None:
            self.publish(handle, Step.Feedback(steps=made, sim_time=now))

        def end(error: Exception | None, made: int, now: float) -> None:
            result.steps, result.sim_time = made, now
            answer(error or f'{made} steps done, now at {now:.6g} s')

        self.stops[handle_number(handle)] = self._steps.begin(steps, feedback, end)


def _filled(message: Any, progress: Progress) -> Any:
    message.way_left, message.angle_left = progress.way_left, progress.angle_left
    message.force, message.sim_time = progress.force, progress.time
    return message


def handle_number(handle: ServerGoalHandle) -> bytes:
    """Return the number of a goal."""
    return bytes(handle.goal_id.uuid)


def _do_nothing() -> None:
    """Stop what has ended."""
