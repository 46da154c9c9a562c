# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""~/pause, ~/step, ~/reset, ~/start_recording, ~/stop_recording, and what follows: ~/state."""

from collections.abc import Callable
from typing import Any

from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.messages.state import state_of
from cloth_sim_ros.node.mode_switch import ModeSwitch
from cloth_sim_ros.node.outlet import Outlet
from cloth_sim_ros.node.recording_session import RecordingSession
from cloth_sim_ros.node.refusals import answer
from cloth_sim_ros.node.refusals import serve_later
from cloth_sim_ros.node.run_loop import RunLoop
from cloth_sim_ros.sim.simulation import Simulation
from rclpy.node import Node
from rclpy.task import Future
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger


def at_rest(simulation: Simulation, action: Callable[[], Any]) -> Future:
    """Return a future with the result of ``action``, called now or when the step has ended."""
    future = Future()

    def act() -> None:
        try:
            future.set_result(action())
        except Exception as error:
            # Raised where it is awaited: it is the answer of a request, not the end of the step.
            future.set_exception(error)

    simulation.stepping.at_rest(act)
    return future


class RecordingServices:
    """
    Serve the requests about recordings.

    :param start: starts a recording of the given name and returns its path
    :param changed: called when a recording has ended
    """

    def __init__(
            self, node: Node, simulation: Simulation, recording: RecordingSession, *,
            start: Callable[[str], str], changed: Callable[[], None]) -> None:
        """Make the services."""
        self._simulation = simulation
        self._recording = recording
        self._start = start
        self._changed = changed
        serve_later(node, StartRecording, '~/start_recording', self._on_start)
        node.create_service(Trigger, '~/stop_recording', answer(self._on_stop))

    async def _on_start(
            self, request: StartRecording.Request, response: StartRecording.Response) -> str:
        # It begins with the state, which is whole between steps.
        response.path = await at_rest(self._simulation, lambda: self._start(request.name))
        return f'recording to {response.path}'

    def _on_stop(self, _: Trigger.Request, __: Trigger.Response) -> str:
        try:
            return f'closed {self._recording.stop()}'
        finally:
            self._changed()


class RunServices:
    """
    Serve the requests about the run as a whole.

    :param reset: puts the cloth back
    :param changed: called when the run state has changed
    """

    def __init__(
            self, node: Node, simulation: Simulation, run_loop: RunLoop, *,
            reset: Callable[[], None], changed: Callable[[], None]) -> None:
        """Make the services."""
        self._simulation = simulation
        self._run_loop = run_loop
        self._reset = reset
        self._changed = changed
        node.create_service(SetBool, '~/pause', answer(self._on_pause))
        serve_later(node, Step, '~/step', self._on_step)
        serve_later(node, Trigger, '~/reset', self._on_reset)

    def _on_pause(self, request: SetBool.Request, _: SetBool.Response) -> str:
        time = self._simulation.stepping.edit_time
        ended = ''
        if request.data:
            ended = self._run_loop.pause()
        else:
            self._run_loop.resume()
        self._changed()
        return f'{self._run_loop.run_state} at {time:.6g} s' + (f'; {ended}' if ended else '')

    async def _on_step(self, request: Step.Request, response: Step.Response) -> str:
        before = self._run_loop.run_state
        try:
            await self._run_loop.step(request.steps)
        finally:
            response.sim_time = self._simulation.time
            if self._run_loop.run_state != before:
                self._changed()
        return f'{request.steps} steps done, now at {self._simulation.time:.6g} s'

    async def _on_reset(self, _: Trigger.Request, __: Trigger.Response) -> str:
        await at_rest(self._simulation, self._reset)
        return f'reset to the start, {self._run_loop.run_state}'


class StateTopic:
    """Send the state put together from the parts that hold it."""

    def __init__(
            self, outlet: Outlet, simulation: Simulation, run_loop: RunLoop,
            switch: ModeSwitch, recording: RecordingSession, frame_id: str) -> None:
        """Keep the parts."""
        self._switch = switch
        self._outlet = outlet
        self._simulation = simulation
        self._run_loop = run_loop
        self._recording = recording
        self._frame_id = frame_id

    def send(self) -> None:
        """Send the state as it is now."""
        state = state_of(
            self._simulation, frame_id=self._frame_id, run_state=self._run_loop.run_state,
            preparing=self._switch.preparing, compiled=self._switch.compiled,
            recording_path=self._recording.path)
        self._outlet.send_message('state', state, self._simulation.stepping.edit_time)
