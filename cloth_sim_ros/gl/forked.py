# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
What a child process that was forked may do with GL.

A fork copies memory, but neither the threads of a driver nor what a GPU knows of a process: in
the child, a call of GL waits for ever for the worker threads of llvmpipe. So contexts of the
parent are refused in the child, and new ones too if the parent's driver had threads.
"""

from contextlib import suppress
import os
from pathlib import Path

from cloth_sim_ros.gl.errors import DeviceError

_WAY_OUT = (
    'create it in the child, which has to be started without a fork of this process: '
    "multiprocessing.get_context('spawn'), or a new program")
_TASKS = Path('/proc/self/task')
# What llvmpipe calls its worker threads, before their number.
_WORKER = 'llvmpipe'


class _Process:
    """
    State of this process and of those it was forked from.

    :ivar forks: since the first of them
    :ivar has_context: whether a context was made
    :ivar has_gpu: whether one was made on a GPU
    :ivar can_begin: whether new contexts work here
    """

    forks = 0
    has_context = False
    has_gpu = False
    can_begin = True
    _had_workers = False

    def look(self) -> None:
        """Note what the child will lack."""
        self._had_workers = self.has_context and (self.has_gpu or _has_workers())

    def become_child(self) -> None:
        """Go on as the child."""
        self.forks += 1
        self.can_begin = self.can_begin and not self._had_workers


_process = _Process()
os.register_at_fork(before=_process.look, after_in_child=_process.become_child)


def forks() -> int:
    """Return the number of forks between this process and the first of its line."""
    return _process.forks


def note_device(is_software: bool) -> None:
    """Note on what device a context was made in this process."""
    _process.has_context = True
    _process.has_gpu |= not is_software


def refuse_new_context() -> None:
    """Raise DeviceError in the child of a process whose driver had threads."""
    if not _process.can_begin:
        raise DeviceError(
            'a GL context cannot be created in this process, which was forked from one whose '
            f'driver runs threads: {_WAY_OUT}')


def refuse_context_of(forks_then: int) -> None:
    """Raise DeviceError where a context was made before a fork, at the count ``forks_then``."""
    if forks_then != _process.forks:
        raise DeviceError(
            'this GL context was created before a fork, and its driver does not run in the '
            f'child: {_WAY_OUT}')


def _has_workers() -> bool:
    if not _TASKS.is_dir():
        return True  # the system does not tell
    names = []
    for task in _TASKS.iterdir():
        with suppress(OSError):  # a thread that has ended meanwhile
            names.append((task / 'comm').read_text(errors='replace'))
    return any(name.startswith(_WORKER) for name in names)
