# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""~/pause, ~/step, ~/reset, ~/start_recording and ~/stop_recording."""

from collections.abc import Callable
from typing import Any

from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.node.device_thread import DeviceThread
from cloth_sim_ros.node.recording_session import RecordingSession
from cloth_sim_ros.node.refusals import serve_later
from cloth_sim_ros.node.run_loop import RunLoop
from cloth_sim_ros.sim.simulation import Simulation
from rclpy.node import Node
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger


class RecordingServices:
    """
    Serve the requests about recordings.

    :param start: starts a recording of the given name, on the device thread; returns its path
    :param started: called with the path
    :param stopped: called when a recording has ended
    """

    def __init__(
            self, node: Node, device: DeviceThread, recording: RecordingSession, *,
            start: Callable[[str], str], started: Callable[[str], str],
            stopped: Callable[[], None]) -> None:
        """Make the services."""
        self._device = device
        self._recording = recording
        self._start = start
        self._started = started
        self._stopped = stopped
        serve_later(node, StartRecording, '~/start_recording', self._on_start)
        serve_later(node, Trigger, '~/stop_recording', self._on_stop)

    async def _on_start(
            self, request: StartRecording.Request, response: StartRecording.Response) -> str:
        # It begins with the state between two steps.
        response.path = await self._device.ask(
            lambda: self._start(request.name), self._started)
        return f'recording to {response.path}'

    async def _on_stop(self, _: Trigger.Request, __: Trigger.Response) -> str:
        path = await self._device.ask(lambda: None, self._stop)
        return f'closed {path}'

    def _stop(self, _: None) -> str:
        # All frames that were made before have been recorded by now.
        try:
            return self._recording.stop()
        finally:
            self._stopped()


class RunServices:
    """
    Serve the requests about the run as a whole.

    :param reset: puts the cloth back, on the device thread
    :param changed: called on the device thread when the run state has changed
    """

    def __init__(
            self, node: Node, device: DeviceThread, simulation: Simulation, run_loop: RunLoop, *,
            reset: Callable[[], None], changed: Callable[[], None]) -> None:
        """Make the services."""
        self._device = device
        self._simulation = simulation
        self._run_loop = run_loop
        self._reset = reset
        self._changed = changed
        serve_later(node, SetBool, '~/pause', self._on_pause)
        serve_later(node, Step, '~/step', self._on_step)
        serve_later(node, Trigger, '~/reset', self._on_reset)

    async def _on_pause(self, request: SetBool.Request, _: SetBool.Response) -> str:
        message: str = await self._device.ask(
            self._pause if request.data else self._resume)
        return message

    def _pause(self) -> str:
        time = self._simulation.time
        ended = self._run_loop.pause()
        self._changed()
        return f'{self._run_loop.run_state} at {time:.6g} s' + (f'; {ended}' if ended else '')

    def _resume(self) -> str:
        self._run_loop.resume()
        self._changed()
        return f'{self._run_loop.run_state} at {self._simulation.time:.6g} s'

    async def _on_step(self, request: Step.Request, response: Step.Response) -> str:
        def begin(answer: Callable[[Any], None]) -> None:
            before = self._run_loop.run_state

            def done(error: Exception | None) -> None:
                response.sim_time = self._simulation.time
                if self._run_loop.run_state != before:
                    self._changed()
                answer(error)

            response.sim_time = self._simulation.time
            self._run_loop.step(request.steps, done)

        await self._device.ask_later(begin)
        return f'{request.steps} steps done, now at {response.sim_time:.6g} s'

    async def _on_reset(self, _: Trigger.Request, __: Trigger.Response) -> str:
        def reset() -> str:
            self._reset()
            return self._run_loop.run_state

        return f'reset to the start, {await self._device.ask(reset)}'
