# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How long to wait between frames so that simulated time keeps to the wall clock."""

from collections import deque

# A late frame is caught up with, but not more than this: a machine that is too slow would
# otherwise run ever longer without a pause.
_CATCH_UP = 0.2
_WINDOW = 1.0


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
