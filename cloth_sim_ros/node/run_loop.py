# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Advance the simulation frame by frame at the pace of the wall clock, or stop at a blow-up."""

from collections import deque
from collections.abc import Callable
import math
import time

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.messages.frame_messages import Pace
from cloth_sim_ros.messages.state import slow_pace
from cloth_sim_ros.node.node_time import NodeTime
from cloth_sim_ros.node.result_codes import CanceledError
from cloth_sim_ros.node.result_codes import InterruptedRequestError
from cloth_sim_ros.node.result_codes import RunFailedError
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import WrongStateError
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.stop import StepAbandoned

# A late frame is caught up with, but not more than this: a machine that is too slow would
# otherwise run ever longer without a pause.
_CATCH_UP = 0.2
_WINDOW = 1.0
# [s] of wall time: between two warnings at least, and how long a run has to keep up before that
# is said.
QUIET = 60.0
STEADY = 5.0
_ROUNDING = 1e-6  # of a whole number of steps [1], as Stepping has it


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
        """Reset the pace: the next frame is due at once."""
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
        self._due = max(self._due + simulated / self.factor, now - _CATCH_UP)
        return max(self._due - now, 0.0)

    @property
    def achieved(self) -> float:
        """Get the simulated time per wall time over the last second; 0 before a frame."""
        if len(self._frames) < 2:
            return 0.0
        (begin, before), (end, after) = self._frames[0], self._frames[-1]
        return (after - before) / (end - begin) if end > begin else 0.0

    @property
    def has_window(self) -> bool:
        """Return whether frames were made for a whole window."""
        return bool(self._frames) and self._frames[-1][0] - self._frames[0][0] >= _WINDOW

    @property
    def too_slow(self) -> bool:
        """Return whether a whole window fell short of the factor requested by over 5 percent."""
        return self.has_window and self.achieved < 0.95 * self.factor


class PaceReport:
    """
    Warns once when a run falls behind, and reports once that it keeps up again.

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

MOST_STEPS = 100000
# Is given None when all steps are made, or why they are not.
Answer = Callable[[Exception | None], None]


class RunLoop:
    """
    Own the run state, and make the frames; all of it on the device thread.

    What a frame simulates comes from ``frame_seconds`` and dt alone; the wall clock only says
    when it is made.

    :param frame_seconds: simulated time of a frame [s]
    :param pacing: when the next frame is due
    :param report: is asked about the pace after each frame
    :param on_frame: called after the state has changed, with what returns how fast that was
    :param on_stop: called when a step was not finite and the run has stopped before it, or when
        it has failed unexpectedly
    :param note: counts an unexpected exception, and returns it in one line
    :param is_due: returns whether a job waits for the end of the step
    :param stop: returns whether to abandon the step
    :param is_held_back: returns whether frames wait that have to be served first
    :param before_part: called before the steps of a frame, and within longer work as often, with
        the length of a frame [s]; returns whether it is needed at all
    :param node_time: may hold the steps back, and hears when they go on
    """

    def __init__(
            self, simulation: Simulation, *, frame_seconds: float, pacing: Pacing,
            report: PaceReport, paused: bool,
            on_frame: Callable[[Callable[[], Pace]], None], on_stop: Callable[[], None],
            note: Callable[[Exception, str], str], is_due: Callable[[], bool],
            stop: Callable[[], bool], is_held_back: Callable[[], bool],
            before_part: Callable[[float], bool], node_time: NodeTime) -> None:
        """Prepare; nothing moves before there is a mode."""
        self._simulation = simulation
        self._frame_seconds = frame_seconds
        self._pacing = pacing
        self._report = report
        self._on_frame = on_frame
        self._on_stop = on_stop
        self._note = note
        self._is_due = is_due
        self._is_stopped = stop
        self._is_held_back = is_held_back
        self._before_part = before_part
        self._time = node_time
        self._paused = paused
        self._problem = ''
        # Steps at the end of the frame, and at that of the part of it that is worked on.
        self._frame_goal = 0
        self._part_end = 0
        # Wall time at which the next frame is due [s].
        self._due = 0.0
        # Who is answered when steps are made, and how many were requested.
        self._answer: Answer | None = None
        self._asked = 0
        self._is_canceled = False
        self._begin_frame()

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
        """Return whether frames are being made."""
        return self.run_state == ClothState.RUNNING

    @property
    def real_time_factor(self) -> float:
        """Get the simulated time per wall time achieved; 0 while nothing runs."""
        return self._pacing.achieved if self.running else 0.0

    def start(self) -> None:
        """Pace frames from now on."""
        self._time.catch_up()
        now = time.monotonic()
        self._pacing.restart(now)
        self._due = now

    def pause(self) -> str:
        """
        Make no more frames or steps.

        :return: what becomes of a request for steps; empty where there is none
        """
        self._paused = True
        if self._answer is None:
            return ''
        made = self._simulation.steps - self._first
        self._simulation.stepping.drop_aim()
        self._end_frame()
        return f'~/step ends there, after {made} of {self._asked} steps'

    def resume(self) -> None:
        """Make frames again; after a stop, try again from the state that was kept."""
        if self._paused or self._problem:
            self._paused = False
            self._problem = ''
            self.start()

    def stop(self, error: ClothSimError) -> None:
        """Stop with ``error``, which is not of a step."""
        self._end_run(error)

    def restart(self) -> None:
        """Drop a stop, and begin with a whole frame."""
        self._problem = ''
        self._begin_frame()
        self._end_steps(InterruptedRequestError(
            'the cloth was reset before all steps were done: request them again'))
        self.start()

    def step(self, steps: int, answer: Answer) -> None:
        """
        Begin to make ``steps`` steps of dt.

        :param answer: called when they are made, or with a NonFiniteStateError when one is lost,
            or a ClothSimError when a pause or a reset comes before the last
        :raises ClothSimError: while running
        """
        if not self._paused and not self._problem:
            raise WrongStateError(
                'the simulation is running, and single steps need it paused: pause it first, with '
                '~/pause with data: true or `cloth_sim pause`')
        if not 1 <= steps <= MOST_STEPS:
            raise ClothSimError(
                f'steps {steps} is outside its range: give a value from 1 to {MOST_STEPS}')
        if self._answer is not None:
            raise WrongStateError(
                'another caller is stepping: wait until ~/step has responded')
        stepping = self._simulation.stepping
        stepping.aim_steps(steps)
        self._begin_frame()
        self._is_frame_open = True
        self._frame_goal = stepping.goal
        self._answer, self._asked, self._is_canceled = answer, steps, False
        self._paused, self._problem = True, ''
        self.start()

    def cancel_steps(self, answer: Answer) -> None:
        """End the steps that ``answer`` waits for; does nothing where they have ended."""
        if self._answer is answer:
            self._is_canceled = True
            self._simulation.stepping.drop_aim()
            self._end_frame()

    def turn(self) -> float | None:
        """Work on the frame that is due; return the time to wait before the next turn [s]."""
        if not self._simulation.is_ready or not (self.running or self._answer is not None):
            return None
        if self._is_held_back():
            return None
        left = self._due - time.monotonic()
        if left > 0.0 and self._answer is None:
            return left
        if self._is_waiting_for_time():
            return None
        self._work()
        return 0.0

    def _is_waiting_for_time(self) -> bool:
        """Return whether the next step is one that the time that is followed has not reached."""
        goal = self._time.goal
        return goal is not None and self._answer is None and self._simulation.steps >= goal

    def _work(self) -> None:
        """Make steps until the frame, or all steps, are made, or a job waits."""
        begin = time.monotonic()
        problem: ClothSimError | DeviceError | None = None
        stepping = self._simulation.stepping
        try:
            if not self._is_frame_open:
                self._begin_frame()
                self._is_frame_open = True
                stepping.aim(self._frame_seconds)
                self._frame_goal = stepping.goal
            stepping.goal = self._part_goal()
            self._simulation.work(self._is_due, self._is_stopped)
        except StepAbandoned:
            return
        except (ClothSimError, DeviceError) as error:
            problem = error
        except Exception as error:
            # A fault in a step comes again with the next: it ends the run, and not the node.
            problem = RunFailedError(
                f'the run failed unexpectedly, {self._note(error, "a step")}: report it with the '
                'trace from the log')
        self._worked += time.monotonic() - begin
        if problem is not None:
            self._end_run(problem)
        elif not stepping.is_behind and self._simulation.steps >= self._frame_goal:
            self._end_frame()

    def _part_goal(self) -> int:
        """Return up to which step to work now: the end of the frame, or of a part of it."""
        goal, steps = self._frame_goal, self._simulation.steps
        if steps >= self._part_end and self._before_part(self._frame_seconds):
            length = math.ceil(self._frame_seconds / self._simulation.dt - _ROUNDING)
            self._part_end = steps + max(length, 1)
        if steps < self._part_end:
            goal = min(goal, self._part_end)
        # Within a frame, the time that is followed may have come less far.
        reached = self._time.goal if self._answer is None else None
        return goal if reached is None else min(goal, reached)

    def _begin_frame(self) -> None:
        """Let what comes next be a whole frame."""
        self._is_frame_open = False
        self._frame_goal = self._part_end = 0
        self._worked = 0.0
        self._first = self._simulation.steps

    def _end_frame(self) -> None:
        # With a frame shorter than dt, some frames have nothing new to show.
        steps, worked = self._simulation.steps - self._first, self._worked
        self._begin_frame()
        self._show(worked, steps)
        now = time.monotonic()
        if self._answer is not None:
            self._end_steps(self._cut_short(steps))
            self._pacing.restart(now)
            self._due = now
        else:
            self._due = now + self._pacing.delay(now, self._frame_seconds)

    def _show(self, worked: float, steps: int) -> None:
        if steps == 0:
            return
        begin, is_running = time.monotonic(), self.running

        def pace() -> Pace:
            # The device may still be at work when the steps return: the read-back waits for it.
            spent = worked + time.monotonic() - begin
            return Pace(
                spent, steps, self.real_time_factor, self._pacing.factor,
                is_running and self._pacing.too_slow)

        try:
            self._on_frame(pace)
        except Exception as error:
            # Whoever waits for the steps has to be answered all the same.
            self._note(error, 'a frame')
        if is_running:
            self._report.look(time.monotonic())

    def _cut_short(self, made: int) -> ClothSimError | None:
        if made == self._asked:
            return None
        if self._is_canceled:
            return CanceledError(
                f'canceled at {self._simulation.time:.6g} s, after {made} of {self._asked} steps')
        return InterruptedRequestError(
            f'~/pause ended the steps at {self._simulation.time:.6g} s, after {made} of '
            f'{self._asked}: request the other {self._asked - made} with ~/step')

    def _end_steps(self, error: Exception | None) -> None:
        answer, self._answer = self._answer, None
        if answer is not None:
            answer(error)

    def _end_run(self, error: ClothSimError | DeviceError) -> None:
        """Publish the last finite state, and report that the run has stopped."""
        self._problem = str(error)
        steps, worked = self._simulation.steps - self._first, self._worked
        self._begin_frame()
        self._show(worked, steps)
        self._end_steps(error)
        self._on_stop()
