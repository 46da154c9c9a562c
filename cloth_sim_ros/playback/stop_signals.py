# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""SIGINT and SIGTERM as a wish to stop."""

import signal
from types import FrameType
from typing import Any

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


class StopSignals:
    """A context manager in which a signal is noted, and breaks nothing off."""

    def __init__(self) -> None:
        """Note nothing yet."""
        self.came = False
        self._before: dict[signal.Signals, Any] = {}

    def __enter__(self) -> 'StopSignals':
        """Listen."""
        self._before = {number: signal.signal(number, self._note) for number in _SIGNALS}
        return self

    def __exit__(self, *_: object) -> None:
        """Leave the signals as they were."""
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _note(self, _number: int, _frame: FrameType | None) -> None:
        self.came = True
