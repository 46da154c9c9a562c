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

"""Advance the simulation frame by frame: running, paused, or stopped by a blow-up."""

from collections.abc import Callable
import time

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_ros.node.pacing import Pacing
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.simulation import Simulation
from rclpy.clock import Clock
from rclpy.clock import ClockType
from rclpy.node import Node

_NANOSECONDS = 1e9
# A frame can take long: after this much wall time [s] services get their turn.
_SLICE = 0.02
# Of a slice: steps made at one go are as many as take about so long.
_PIECE = 0.25
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
    :param on_stop: called when a step was not finite and the run has stopped before it
    """

    def __init__(
            self, node: Node, simulation: Simulation, *, frame_seconds: float, pacing: Pacing,
            paused: bool, on_frame: Callable[[float, int], None],
            on_stop: Callable[[], None]) -> None:
        """Make the timer; nothing moves before start."""
        self._node = node
        self._simulation = simulation
        self._frame_seconds = frame_seconds
        self._pacing = pacing
        self._on_frame = on_frame
        self._on_stop = on_stop
        self._paused = paused
        self._problem = ''
        self._piece = 1
        self._begin_frame()
        # Simulated time may stand still, or come from this very node: only a steady clock paces.
        self._timer = node.create_timer(
            1.0, self._make_frame, clock=Clock(clock_type=ClockType.STEADY_TIME))
        self._timer.cancel()

    @property
    def run_state(self) -> str:
        """ClothState.RUNNING, PAUSED or STOPPED."""
        if self._problem:
            return ClothState.STOPPED
        return ClothState.PAUSED if self._paused else ClothState.RUNNING

    @property
    def problem(self) -> str:
        """Why the run has stopped; empty when it has not."""
        return self._problem

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
        """Make no more frames."""
        self._paused = True
        self._timer.cancel()

    def resume(self) -> None:
        """Make frames again; after a stop, try again from the state that was kept."""
        if not self.running:
            self._paused = False
            self._problem = ''
            self.start()

    def restart(self) -> None:
        """Forget a stop, and begin with a whole frame."""
        self._problem = ''
        self._begin_frame()
        self.start()

    def step(self, steps: int) -> None:
        """Make ``steps`` steps of dt now; ClothSimError while running, or when one is lost."""
        if self.running:
            raise ClothSimError(
                'the simulation is running, and ~/step needs it paused: call ~/pause with '
                'data: true first')
        if not 1 <= steps <= MOST_STEPS:
            raise ClothSimError(
                f'steps {steps} is outside its range: give a value from 1 to {MOST_STEPS}')
        self._begin_frame()
        try:
            while self._steps < steps and self._node.context.ok():
                self._make_piece(min(self._piece, steps - self._steps))
        except NonFiniteStateError as error:
            self._stop(error)
            raise
        finally:
            worked, made = self._worked, self._steps
            self._begin_frame()
        self._paused, self._problem = True, ''
        self._on_frame(worked, made)

    def _begin_frame(self) -> None:
        self._left = self._frame_seconds
        self._worked = 0.0
        self._steps = 0

    def _make_frame(self) -> None:
        try:
            self._make_part()
        except NonFiniteStateError as error:
            self._stop(error)
            return
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
            seconds = min(self._left, self._piece * self._simulation.dt)
            self._make_piece(seconds=seconds)
            self._left -= seconds

    def _make_piece(self, steps: int = 0, *, seconds: float = 0.0) -> None:
        first = self._simulation.steps
        begin = time.monotonic()
        try:
            if steps:
                self._simulation.step(steps)
            else:
                self._simulation.advance(seconds)
        finally:
            # Each piece is checked at its end, so it should not be shorter than it has to be.
            took = time.monotonic() - begin
            self._piece = min(self._piece * 2, MOST_STEPS) if took < _PIECE * _SLICE \
                else max(1, self._piece // 2)
            self._worked += took
            self._steps += self._simulation.steps - first

    def _stop(self, error: NonFiniteStateError) -> None:
        """Show the last finite state, and tell that there is no more to come."""
        self._timer.cancel()
        self._problem = str(error)
        worked, steps = self._worked, self._steps
        self._begin_frame()
        if steps:
            self._on_frame(worked, steps)
        self._on_stop()

    def _wait(self, seconds: float) -> None:
        self._timer.timer_period_ns = int(seconds * _NANOSECONDS)
        self._timer.reset()
