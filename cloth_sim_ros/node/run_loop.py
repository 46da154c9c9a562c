# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Advance the simulation frame by frame: running, paused, or stopped by a bad state."""

from collections.abc import Callable
import time

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_ros.node.pacing import Pacing
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.simulation import Simulation
from rclpy.clock import Clock
from rclpy.clock import ClockType
from rclpy.node import Node

_NANOSECONDS = 1e9
# A frame can take long: after this much wall time [s] services get their turn.
_SLICE = 0.02
MOST_STEPS = 100000


class RunLoop:
    """
    Own the run state and the timer that makes the frames.

    What a frame simulates comes from ``frame_seconds`` and dt alone; the wall clock only says
    when it is made.

    :param frame_seconds: simulated time of a frame [s]
    :param pacing: when the next frame is due
    :param on_frame: called after the state has changed, with the wall time that took [s] and the
        steps of dt made
    """

    def __init__(
            self, node: Node, simulation: Simulation, *, frame_seconds: float, pacing: Pacing,
            paused: bool, on_frame: Callable[[float, int], None]) -> None:
        """Make the timer; nothing moves before start."""
        self._node = node
        self._simulation = simulation
        self._frame_seconds = frame_seconds
        self._pacing = pacing
        self._on_frame = on_frame
        self._paused = paused
        self._stopped = False
        self._begin_frame()
        # Simulated time may stand still, or come from this very node: only a steady clock paces.
        self._timer = node.create_timer(
            1.0, self._make_frame, clock=Clock(clock_type=ClockType.STEADY_TIME))
        self._timer.cancel()

    @property
    def run_state(self) -> str:
        """ClothState.RUNNING, PAUSED or STOPPED."""
        if self._stopped:
            return ClothState.STOPPED
        return ClothState.PAUSED if self._paused else ClothState.RUNNING

    @property
    def running(self) -> bool:
        """Tell whether frames are being made."""
        return self.run_state == ClothState.RUNNING

    @property
    def real_time_factor(self) -> float:
        """Get the simulated time per wall time achieved; 0 while nothing runs."""
        return self._pacing.achieved if self.running else 0.0

    def start(self) -> None:
        """Make frames from now on, unless paused or stopped."""
        self._pacing.restart(time.monotonic())
        if self.running:
            self._wait(0.0)

    def pause(self) -> None:
        """Make no more frames; a ClothSimError tells that the run is stopped."""
        self._refuse_when_stopped('pause')
        self._paused = True
        self._timer.cancel()

    def resume(self) -> None:
        """Make frames again; a ClothSimError tells that the run is stopped."""
        self._refuse_when_stopped('resume')
        if self._paused:
            self._paused = False
            self.start()

    def stop(self) -> None:
        """Make no more frames before restart, whatever is asked for."""
        self._stopped = True
        self._timer.cancel()

    def restart(self) -> None:
        """Undo stop, and begin with a whole frame."""
        self._stopped = False
        self._begin_frame()
        self.start()

    def step(self, steps: int) -> None:
        """Make ``steps`` steps of dt now; ClothSimError unless paused."""
        self._refuse_when_stopped('step')
        if not self._paused:
            raise ClothSimError(
                'the simulation is running, and ~/step needs it paused: call ~/pause with '
                'data: true first')
        if not 1 <= steps <= MOST_STEPS:
            raise ClothSimError(
                f'steps {steps} is outside its range: give a value from 1 to {MOST_STEPS}')
        begin = time.monotonic()
        done = 0
        while done < steps and self._node.context.ok():
            self._simulation.step()
            done += 1
        self._on_frame(time.monotonic() - begin, done)

    def _begin_frame(self) -> None:
        self._left = self._frame_seconds
        self._worked = 0.0
        self._steps = 0

    def _make_frame(self) -> None:
        self._make_part()
        if self._left > 0.0:
            self._wait(0.0)
            return
        worked, steps = self._worked, self._steps
        self._begin_frame()
        # With a frame shorter than dt, some frames have nothing new to show.
        if steps:
            self._on_frame(worked, steps)
        delay = self._pacing.delay(time.monotonic(), self._frame_seconds)
        if self.running:
            self._wait(delay)

    def _make_part(self) -> None:
        begin = time.monotonic()
        while self._left > 0.0 and time.monotonic() - begin < _SLICE:
            part = min(self._left, self._simulation.dt)
            self._steps += self._simulation.advance(part)
            self._left -= part
        self._worked += time.monotonic() - begin

    def _wait(self, seconds: float) -> None:
        self._timer.timer_period_ns = int(seconds * _NANOSECONDS)
        self._timer.reset()

    def _refuse_when_stopped(self, request: str) -> None:
        if self._stopped:
            raise ClothSimError(
                f'the run has stopped because its state is not finite, and cannot {request}: '
                'call ~/reset first')
