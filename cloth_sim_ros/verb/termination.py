# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What verbs say beside their result, and SIGINT and SIGTERM as a wish to stop."""

from collections.abc import Callable
from collections.abc import Iterator
from contextlib import contextmanager
import signal
import sys
from types import FrameType
from typing import Any
from typing import NoReturn


def sayer(verb: str) -> Callable[[str], None]:
    """Return what prints a sentence of ``verb`` to stderr."""
    return lambda sentence: print(f'cloth_sim {verb}: {sentence}', file=sys.stderr)


class Terminated(KeyboardInterrupt):
    """SIGTERM came: whoever cleans up after Ctrl-C cleans up after this as well."""


@contextmanager
def raise_on_sigterm() -> Iterator[None]:
    """Raise Terminated in the main thread when SIGTERM comes; further ones change nothing."""
    before = signal.getsignal(signal.SIGTERM)
    signal.signal(signal.SIGTERM, _raise)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _raise(_number: int, _frame: FrameType | None) -> NoReturn:
    # What is cleaned up must not be broken off.
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    raise Terminated


# SIGINT and SIGTERM as a wish to stop.

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
