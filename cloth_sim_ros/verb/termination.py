# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What verbs say beside their result; SIGINT, SIGTERM and closed pipes as a wish to stop."""

from collections.abc import Callable
from collections.abc import Iterator
from contextlib import contextmanager
import os
import select
import signal
import sys
import threading
from types import FrameType
from typing import Any
from typing import NoReturn


def reporter(verb: str) -> Callable[[str], None]:
    """Return what prints a sentence of ``verb`` to stderr."""
    return lambda sentence: print(f'cloth_sim {verb}: {sentence}', file=sys.stderr)


_SIGNALS = (signal.SIGINT, signal.SIGTERM)
_Handler = Callable[[int, FrameType | None], Any]


class Terminated(KeyboardInterrupt):
    """SIGTERM came: whoever cleans up after Ctrl-C cleans up after this as well."""


# What is raised in these does not come out of them.
_CLOSED = ('from_param', '__del__')
# How long to wait for their end [s].
_SOON = 0.001


@contextmanager
def interruptible() -> Iterator[None]:
    """
    Raise Terminated in the main thread when SIGTERM comes; further ones change nothing.

    That, and what Python does at SIGINT, waits while ctypes converts an argument, which makes an
    ArgumentError of whatever is raised, and while an object is deleted, where it is dropped.
    """
    before = {number: signal.getsignal(number) for number in _SIGNALS}
    signal.signal(signal.SIGTERM, _where_it_comes_out(_raise_terminated))
    if before[signal.SIGINT] is signal.default_int_handler:
        signal.signal(signal.SIGINT, _where_it_comes_out(signal.default_int_handler))
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _where_it_comes_out(handler: _Handler) -> _Handler:
    def handle(number: int, frame: FrameType | None) -> None:
        if _is_closed(frame):
            # To the main thread, which may be asleep.
            main = threading.main_thread().ident
            threading.Timer(_SOON, signal.pthread_kill, (main, number)).start()
        else:
            handler(number, frame)

    return handle


def _is_closed(frame: FrameType | None) -> bool:
    while frame is not None:
        if frame.f_code.co_name in _CLOSED:
            return True
        frame = frame.f_back
    return False


def _raise_terminated(_number: int, _frame: FrameType | None) -> NoReturn:
    # What is cleaned up must not be broken off.
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    raise Terminated


def leave_broken_pipes() -> bool:
    """
    Have what is still printed go nowhere, where stdout or stderr is a pipe that nobody reads.

    :return: whether there is such a pipe, as in `cloth_sim info ... | head`
    """
    found = False
    for stream in (sys.stdout, sys.stderr):
        try:
            number = stream.fileno()
        except (OSError, ValueError):  # of a test, or closed
            continue
        pipe = select.poll()
        pipe.register(number, 0)
        if any(event & select.POLLERR for _, event in pipe.poll(0)):
            found = True
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, number)
            os.close(nowhere)
    return found


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
