# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Messages that ask for what can't be: a topic has no answer, so the log has the reason."""

from collections.abc import Callable

from cloth_sim_ros.node.log_throttle import LogThrottle

QUIET = 1.0  # [s] of wall time between two warnings of one topic


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
