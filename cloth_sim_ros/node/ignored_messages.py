# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Messages that ask for what cannot be: topics have no answer, so the log has them."""

from collections.abc import Callable
import time

_MOST_KINDS = 100
QUIET = 1.0  # [s] of wall time between two warnings of one topic


class LogThrottle:
    """
    Decide what to log of things of many kinds.

    :param quiet: time between two lines of the same kind [s]
    :param clock: wall time [s]
    """

    def __init__(self, quiet: float, clock: Callable[[], float] = time.monotonic) -> None:
        """Begin with nothing logged."""
        self._quiet = quiet
        self._clock = clock
        # Of each kind: when it was logged, and how many were left out since.
        self._logged: dict[str, tuple[float, int]] = {}

    def left_out(self, kind: str) -> int | None:
        """
        Return how many of this kind were left out since one was logged.

        None when this one is to be left out as well.
        """
        now = self._clock()
        logged, missed = self._logged.get(kind, (-self._quiet, 0))
        if now - logged < self._quiet:
            self._logged[kind] = logged, missed + 1
            return None
        if len(self._logged) >= _MOST_KINDS:
            self._logged.clear()
        self._logged[kind] = now, 0
        return missed


class IgnoredMessages:
    """
    Count the messages that are ignored, and warn of them, but not of each in a flood.

    :param warn: is given each warning
    """

    def __init__(self, warn: Callable[[str], object]) -> None:
        """Begin with none."""
        self._warn = warn
        self._throttle = LogThrottle(QUIET)
        self.count = 0

    def note(self, topic: str, error: Exception) -> None:
        """Count a message on ``topic`` that is ignored because of ``error``."""
        self.count += 1
        missed = self._throttle.left_out(topic)
        if missed is None:
            return
        others = f'; {missed} others since the last warning' if missed else ''
        self._warn(f'a message on {topic} is ignored: {error}{others}')
