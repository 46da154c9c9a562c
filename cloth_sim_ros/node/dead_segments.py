# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Shared memory that killed processes left behind, given back to the machine.

The rule is that of Fast DDS: beside each segment lies a lock file, on which its process holds an
exclusive lock (flock) for as long as it lives. Who gets that lock knows that the process is dead.
"""

from dataclasses import dataclass
import fcntl
import os
from pathlib import Path
import re
import stat
import time

SHARED_MEMORY = Path('/dev/shm')
# Fast DDS 2 and 3. Segments have random names, which no process ever takes a second time.
_LOCK = re.compile(r'(fast(?:rtps|dds)_[0-9a-f]{16})_el')
# A process that has just made its lock file may not have locked it yet [s].
_YOUNG = 5.0


@dataclass(frozen=True)
class Reclaimed:
    """
    What was given back.

    :param segments: how many there were
    :param size: of all of them [bytes]
    """

    segments: int = 0
    size: int = 0

    def __str__(self) -> str:
        """Return one sentence; empty when there was nothing."""
        if not self.segments:
            return ''
        plural = '' if self.segments == 1 else 's'
        return (
            f'reclaimed {self.size / 1e6:.3g} MB of shared memory in {SHARED_MEMORY}: '
            f'{self.segments} segment{plural} of Fast DDS whose process was killed')


def reclaim_dead_segments(folder: Path = SHARED_MEMORY, young: float = _YOUNG) -> Reclaimed:
    """
    Remove the segments of this user's dead processes.

    Segments of living processes and of other users are left alone, and so are ports, which Fast
    DDS itself resets when a process next uses them.

    :param folder: where the segments lie
    :param young: age below which a segment is left alone [s]
    """
    sizes = []
    try:
        names = os.listdir(folder)
    except OSError:
        return Reclaimed()
    for name in names:
        found = _LOCK.fullmatch(name)
        if found:
            size = _reclaim(folder / found[1], folder / name, young)
            sizes += [] if size is None else [size]
    return Reclaimed(len(sizes), sum(sizes))


def _reclaim(segment: Path, lock: Path, young: float) -> int | None:
    """Return the size of a dead segment that was removed; None where there was none to remove."""
    try:
        handle = os.open(lock, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    except OSError:
        return None
    try:
        locked = os.fstat(handle)
        if not _is_own(locked) or time.time() - locked.st_mtime < young:
            return None
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        # Somebody else may have removed it since it was opened.
        if not os.path.samestat(os.lstat(lock), locked):
            return None
        size = _remove_segment(segment)
        # Last, so that whoever is killed before this line leaves it to the next.
        os.unlink(lock)
        return size
    except OSError:
        return None  # it is locked, and so its process lives, or it has gone meanwhile
    finally:
        os.close(handle)


def _remove_segment(segment: Path) -> int | None:
    try:
        found = os.lstat(segment)
    except FileNotFoundError:
        return None  # a living reader of the dead process has removed it
    if not _is_own(found):
        return None
    os.unlink(segment)
    return found.st_size


def _is_own(found: os.stat_result) -> bool:
    return found.st_uid == os.geteuid() and stat.S_ISREG(found.st_mode)
