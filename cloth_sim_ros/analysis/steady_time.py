# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Simulated time that only grows, over the resets of a run."""

from typing import Any


class SteadyTime:
    """
    Turns the stamps of a recording, one behind the other, into times that go on over resets.

    A reset puts the stamps back to 0, of every topic. Messages of one topic come in their order;
    those of several may not, when another program recorded them: one that is late is no reset.
    """

    def __init__(self) -> None:
        """Begin before the first message."""
        self.now = 0.0
        self.resets = 0        # before the message read last
        self._offsets = [0.0]  # of each span between two resets
        self._latest = 0.0     # time of any message
        self._last: dict[str, tuple[float, int]] = {}

    def read(self, stamp: Any, topic: str = '') -> float:
        """Return the time [s] of the next message of ``topic``, which is stamped ``stamp``."""
        stamped = stamp.sec + 1e-9 * stamp.nanosec
        before, span = self._last.get(topic, (0.0, 0))
        if stamped < before:
            span += 1
            if span == len(self._offsets):
                self._offsets.append(self._latest)
        # A topic that is seldom sent learns of a reset from the others.
        span = min(
            range(span, len(self._offsets)),
            key=lambda later: abs(stamped + self._offsets[later] - self._latest))
        self._last[topic] = stamped, span
        self.resets = span
        self.now = stamped + self._offsets[span]
        self._latest = max(self._latest, self.now)
        return self.now
