# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Advance the simulation frame by frame at the pace of the wall clock, or stop at a blow-up."""

from collections import deque
from collections.abc import Callable
import math
import time

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.messages.state import slow_pace
from cloth_sim_ros.node.frame_executor import Alarm
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.modes import Pieces
from cloth_sim_ros.sim.simulation import Simulation
from rclpy.task import Future

# A late frame is caught up with, but not more than this: a machine that is too slow would
# otherwise run ever longer without a pause.
_CATCH_UP = 0.2
_WINDOW = 1.0
# [s] of wall time: between two warnings at least, and how long a run has to keep up before that
# is said.
QUIET = 60.0
STEADY = 5.0


class Pacing:
    """
    Pace frames of simulated time by the wall clock, and measure the pace achieved.

    The caller gives the wall time in seconds, of any clock that only goes forward.

    :param factor: simulated time per wall time to keep to; 0: as fast as possible
    """

    def __init__(self, factor: float) -> None:
        """Start without a history; call restart before the first frame."""
        self.factor = factor
        self._due = 0.0
        self._simulated = 0.0
        self._frames: deque[tuple[float, float]] = deque()

    def restart(self, now: float) -> None:
        """Forget the past: the next frame is due at once."""
        self._due = now
        self._simulated = 0.0
        self._frames = deque([(now, 0.0)])

    def delay(self, now: float, simulated: float) -> float:
        """Return the wall seconds to wait after a frame of ``simulated`` seconds."""
        if self.factor and len(self._frames) == 1:
            # The first frame is made at once, and yet stands for as long as every other.
            self._frames[0] = (min(self._frames[0][0], now - simulated / self.factor), 0.0)
        self._simulated += simulated
        self._frames.append((now, self._simulated))
        while len(self._frames) > 2 and now - self._frames[1][0] >= _WINDOW:
            self._frames.popleft()
        if self.factor == 0.0:
            self._due = now
            return 0.0
        self._due = max(self._due_after(simulated), now - _CATCH_UP)
        return max(self._due - now, 0.0)

    def is_next_due(self, now: float, simulated: float) -> bool:
        """Tell whether ``delay`` would return 0 for the frame that has ended."""
        return self.factor == 0.0 or self._due_after(simulated) <= now

    def _due_after(self, simulated: float) -> float:
        return self._due + simulated / self.factor

    @property
    def achieved(self) -> float:
        """Get the simulated time per wall time over the last second; 0 before a frame."""
        if len(self._frames) < 2:
            return 0.0
        (begin, before), (end, after) = self._frames[0], self._frames[-1]
        return (after - before) / (end - begin) if end > begin else 0.0

    @property
    def has_window(self) -> bool:
        """Tell whether frames were made for a whole window."""
        return bool(self._frames) and self._frames[-1][0] - self._frames[0][0] >= _WINDOW

    @property
    def too_slow(self) -> bool:
        """Tell whether a whole window fell short of the factor asked for by over 5 percent."""
        return self.has_window and self.achieved < 0.95 * self.factor


class PaceReport:
    """
    Warns once where a run falls behind, and says once that it keeps up again.

    :param warn: is given the warning
    :param say: is given what is no warning
    """

    def __init__(
            self, simulation: Simulation, pacing: Pacing, *, warn: Callable[[str], object],
            say: Callable[[str], object]) -> None:
        """Begin with a run that keeps up."""
        self._simulation = simulation
        self._pacing = pacing
        self._warn = warn
        self._say = say
        self._is_behind = False
        self._warned = -math.inf
        self._steady_since = math.inf

    def look(self, now: float) -> None:
        """Look at the pace at the wall time ``now`` [s]."""
        pacing = self._pacing
        if pacing.too_slow:
            self._steady_since = math.inf
            if not self._is_behind and now - self._warned >= QUIET:
                self._is_behind, self._warned = True, now
                self._warn(slow_pace(
                    pacing.achieved, pacing.factor, substeps=self._simulation.substeps,
                    automatic=self._simulation.scene['auto_substeps'],
                    mode=self._simulation.mode))
        elif self._is_behind and pacing.has_window:
            self._steady_since = min(self._steady_since, now)
            if now - self._steady_since >= STEADY:
                self._is_behind = False
                self._say(f'{pacing.achieved:.3g} x real time: the run keeps up again')


# Advance the simulation frame by frame: running, paused, or stopped by a blow-up.

# A step can take long: after this much wall time [s] services get their turn.
_SLICE = 0.01
MOST_STEPS = 100000


class RunLoop:
    """
    Own the run state, and make the frames when the alarm rings.

    What a frame simulates comes from ``frame_seconds`` and dt alone; the wall clock only says
    when it is made. Work is done in slices, between which everything else is served; a slice can
    end within a step.

    :param alarm: rings for the next slice of work
    :param frame_seconds: simulated time of a frame [s]
    :param pacing: when the next frame is due
    :param on_frame: called after the state has changed, with the wall time that took [s], the
        steps of dt made, and whether it is to return what sends the frame, or None, in place of
        waiting for the device
    :param on_stop: called when a step was not finite and the run has stopped before it, or when
        it has failed unexpectedly
    :param note: counts an unexpected exception, and returns it in one line
    :param overlaps: True begins the next frame, where it is due, before the last one is sent
    """

    def __init__(
            self, alarm: Alarm, simulation: Simulation, *, frame_seconds: float, pacing: Pacing,
            paused: bool, on_frame: Callable[[float, int, bool], Callable[[], None] | None],
            on_stop: Callable[[], None], note: Callable[[Exception, str], str],
            overlaps: bool = False) -> None:
        """Prepare; nothing moves before start."""
        self._simulation = simulation
        self._frame_seconds = frame_seconds
        self._pacing = pacing
        self._on_frame = on_frame
        self._on_stop = on_stop
        self._note = note
        self._overlaps = overlaps
        self._paused = paused
        self._problem = ''
        # Pieces of the step under way, and when the slice ends.
        self._work: Pieces | None = None
        self._deadline = 0.0
        # What a caller of step waits for, how many steps it asked for, and the first of them.
        self._answer: Future | None = None
        self._asked = 0
        self._asked_from: int | None = None
        self._begin_frame()
        alarm.ring = self._make_slice
        self._alarm = alarm

    @property
    def run_state(self) -> str:
        """ClothState.PREPARING, RUNNING, PAUSED or STOPPED."""
        if self._problem:
            return ClothState.STOPPED
        if self._paused:
            return ClothState.PAUSED
        return ClothState.RUNNING if self._simulation.is_ready else ClothState.PREPARING

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
        """Make frames from now on, unless paused or stopped, and the steps asked for."""
        self._pacing.restart(time.monotonic())
        if self._simulation.is_ready and (self.running or self._answer is not None):
            self._alarm.ring_in(0.0)

    def pause(self) -> str:
        """
        Make no more frames or steps; a step of dt under way comes to its end.

        :return: what becomes of a request for steps; empty where there is none
        """
        self._paused = True
        if self._answer is None:
            return ''
        stepping, answer = self._simulation.stepping, self._answer
        stepping.at_rest(lambda: self._cut_steps(answer))
        made = 0 if self._asked_from is None else stepping.edit_step - self._asked_from
        return f'~/step ends there, after {made} of {self._asked} steps'

    def _cut_steps(self, answer: Future) -> None:
        # A reset that came first has answered the request already.
        if self._answer is answer:
            self._simulation.stepping.drop_aim()
            self._alarm.ring_in(0.0)

    def resume(self) -> None:
        """Make frames again; after a stop, try again from the state that was kept."""
        if self._paused or self._problem:
            self._paused = False
            self._problem = ''
            self.start()

    def restart(self) -> None:
        """Forget a stop, and begin with a whole frame."""
        self._problem = ''
        self._begin_frame()
        self._end_steps(ClothSimError(
            'the cloth was reset before all steps were done: request them again'))
        self.start()

    def close(self) -> None:
        """Undo a step under way, while there is a device to do so."""
        self._alarm.cancel()
        if self._work is not None:
            self._work.close()

    def step(self, steps: int) -> Future:
        """
        Begin to make ``steps`` steps of dt.

        :return: done when they are made, with a NonFiniteStateError when one is lost, or a
            ClothSimError when a pause or a reset comes before the last
        :raises ClothSimError: while running
        """
        if not self._paused and not self._problem:
            raise ClothSimError(
                'the simulation is running, and single steps need it paused: pause it first, with '
                '~/pause with data: true or `cloth_sim pause`')
        if not 1 <= steps <= MOST_STEPS:
            raise ClothSimError(
                f'steps {steps} is outside its range: give a value from 1 to {MOST_STEPS}')
        if self._answer is not None:
            raise ClothSimError(
                'another caller is stepping: wait until ~/step has responded')
        answer = self._answer = Future()
        self._asked, self._asked_from = steps, None
        self._paused, self._problem = True, ''
        self._simulation.stepping.at_rest(lambda: self._begin_steps(steps))
        self.start()
        return answer

    def _begin_steps(self, steps: int) -> None:
        self._begin_frame()
        self._is_frame_open = True
        self._asked_from = self._first
        try:
            self._simulation.stepping.aim_steps(steps)
        except ClothSimError as error:
            self._begin_frame()
            self._end_steps(error)

    def _begin_frame(self) -> None:
        """Let what comes next be a whole frame."""
        self._is_frame_open = False
        self._worked = 0.0
        self._first = self._simulation.steps

    def _make_slice(self) -> None:
        if not (self.running or self._answer is not None or self._work is not None):
            self._alarm.cancel()
            return
        if self._work_on(_SLICE):
            self._end_frame()
        elif not self._problem:
            self._alarm.ring_in(0.0)

    def _work_on(self, seconds: float, then: Callable[[], None] | None = None) -> bool:
        """
        Work on the frame for some wall time; return whether it, or all steps, are made.

        :param then: called after that, and before the run stops at what went wrong in it
        """
        begin = time.monotonic()
        self._deadline = begin + seconds
        problem: ClothSimError | DeviceError | None = None
        is_made = False
        try:
            if not self._is_frame_open and self._work is None:
                self._begin_frame()
                self._is_frame_open = True
                self._simulation.stepping.aim(self._frame_seconds)
            is_made = self._go_on()
        except (ClothSimError, DeviceError) as error:
            problem = error
        except Exception as error:
            # A fault in a step comes again with the next: it ends the run, and not the node.
            problem = ClothSimError(
                f'the run failed unexpectedly, {self._note(error, "a step")}: report it with the '
                'trace from the log')
        self._worked += time.monotonic() - begin
        if then is not None:
            then()
        if problem is not None:
            self._stop(problem)
        return is_made

    def _go_on(self) -> bool:
        """Work until the slice is over; return whether the frame, or all steps, are made."""
        while self._work is not None or self._simulation.stepping.is_behind:
            if self._work is None:
                self._work = self._simulation.work(self._is_due)
            for _ in self._work:
                if time.monotonic() >= self._deadline:
                    return False
            self._work = None
            if self._is_due():
                return not self._simulation.stepping.is_behind
        return True

    def _is_due(self) -> bool:
        is_held = self._paused and self._answer is None
        return is_held or time.monotonic() >= self._deadline

    def _end_frame(self) -> None:
        # With a frame shorter than dt, some frames have nothing new to show.
        steps, worked = self._simulation.steps - self._first, self._worked
        self._begin_frame()
        if steps > 0 and self._overlaps and self._answer is None and self.running and (
                self._pacing.is_next_due(time.monotonic(), self._frame_seconds)):
            send = self._on_frame(worked, steps, True)
            # One piece, for the device to work on while the host waits, and sends. Nothing else
            # is served before that: no request meets a frame that has not been sent.
            self._work_on(0.0, then=send)
        elif steps > 0:
            self._on_frame(worked, steps, False)
        if self._answer is not None:
            self._end_steps(self._cut_short(steps))
            self._pacing.restart(time.monotonic())
            delay = 0.0
        else:
            delay = self._pacing.delay(time.monotonic(), self._frame_seconds)
        if self.running:
            self._alarm.ring_in(delay)
        else:
            self._alarm.cancel()

    def _cut_short(self, made: int) -> ClothSimError | None:
        if made == self._asked:
            return None
        return ClothSimError(
            f'~/pause ended the steps at {self._simulation.time:.6g} s, after {made} of '
            f'{self._asked}: request the other {self._asked - made} with ~/step')

    def _end_steps(self, error: Exception | None) -> None:
        answer, self._answer = self._answer, None
        if answer is not None and error is not None:
            answer.set_exception(error)
        elif answer is not None:
            answer.set_result(None)

    def _stop(self, error: ClothSimError | DeviceError) -> None:
        """Show the last finite state, and tell that there is no more to come."""
        self._alarm.cancel()
        self._work = None
        self._problem = str(error)
        steps, worked = self._simulation.steps - self._first, self._worked
        self._begin_frame()
        if steps > 0:
            self._on_frame(worked, steps, False)
        self._end_steps(error)
        self._on_stop()
