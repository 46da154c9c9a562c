# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Keep simulated time to the wall clock, and say when it can not."""

from collections import deque
from collections.abc import Callable
import math

from cloth_sim_ros.messages.state import slow_pace
from cloth_sim_ros.sim.simulation import Simulation

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
                    automatic=self._simulation.scene['auto_substeps']))
        elif self._is_behind and pacing.has_window:
            self._steady_since = min(self._steady_since, now)
            if now - self._steady_since >= STEADY:
                self._is_behind = False
                self._say(f'{pacing.achieved:.3g} x real time: the run keeps up again')
