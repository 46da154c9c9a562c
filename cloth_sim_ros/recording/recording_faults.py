# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Why a recording cannot begin or continue, or was cut off or changed, and the remedy."""

import errno
import io
import os
from pathlib import Path
from typing import Any

from cloth_sim_ros.sim.errors import ClothSimError


class FileChangedError(OSError):
    """Another program has changed a file that is being written."""


class WatchedFile(io.FileIO):
    """
    A fresh file, written from its begin to its end.

    Each write is preceded by a check of the file's length: what is written behind a truncation
    would stand behind a hole of zeros, or behind half a record.

    :raises OSError: when it can't be made, or is there already
    """

    def __init__(self, path: Path) -> None:
        """Make the file."""
        super().__init__(path, 'xb', opener=_open_for_appending)
        self._path = path
        self._is_given_up = False
        self.written = 0  # bytes

    def write(self, data: Any) -> int:
        """
        Append ``data`` and return how many of its bytes were written.

        :raises FileChangedError: when the file is not as it was left
        """
        if self._is_given_up:
            return memoryview(data).nbytes
        self._check_length()
        count = super().write(data)
        self.written += count
        return count

    def check(self) -> None:
        """Raise FileChangedError unless the file is as it was left, under its own name."""
        self._check_length()
        try:
            named = os.stat(self._path)
        except OSError as error:
            # Removed a moment ago, it has no name at all.
            self._check_length()
            raise FileChangedError(
                f'{self._path.name} is no longer in its folder ({error.strerror})') from error
        if not os.path.samestat(named, os.fstat(self.fileno())):
            raise self._removed()

    def give_up(self, length: int) -> None:
        """Drop all further writes, and what stands behind the first ``length`` bytes."""
        self._is_given_up = True
        # Never longer: of a file that was truncated, nothing comes back but a hole.
        if os.fstat(self.fileno()).st_size > length:
            os.ftruncate(self.fileno(), length)

    def _check_length(self) -> None:
        present = os.fstat(self.fileno())
        if present.st_nlink == 0:
            raise self._removed()
        if present.st_size < self.written:
            raise FileChangedError(
                f'{self._path.name} was truncated by another program, from {self.written} to '
                f'{present.st_size} bytes')
        if present.st_size > self.written:
            raise FileChangedError(f'another program has written to {self._path.name}')

    def _removed(self) -> FileChangedError:
        return FileChangedError(
            f'{self._path.name} was removed or replaced by another program')


def _open_for_appending(path: str, flags: int) -> int:
    # Between the check and the write the file could still be cut: no hole then, either.
    return os.open(path, flags | os.O_APPEND, 0o666)


# Why a recording cannot begin or continue, or was cut off, and the remedy.

_NO_ROOM = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}
_TOO_MANY_FILES = {errno.EMFILE, errno.ENFILE}
_USED_UP = {errno.ENOMEM, errno.EAGAIN}


class RecordingError(ClothSimError):
    """A recording that could not continue; what was flushed before stays readable."""


class RecordingFull(RecordingError):
    """A recording that was completed before it was stopped, as it may not become larger."""


def nothing_flushed(path: Path, finding: str) -> ClothSimError:
    """
    Return the error of the bag or file ``path``.

    :param finding: state of the file instead of a recording; follows the path in the message
    """
    return ClothSimError(
        f'{path} {finding}: its writer was killed before the first flush, or messages were '
        'cut off or removed since; give another recording, or read it later if it is being '
        'recorded')


def refusal(folder: Path, error: Exception, setting: str) -> ClothSimError:
    """
    Return the error of a recording that cannot begin.

    :param folder: that it should have gone into
    :param setting: what ``folder`` was given by
    """
    return RecordingError(
        f'cannot record into {folder} ({_reason(error)}): {_way_out(error, setting)}')


def ending(path: Path, error: Exception, setting: str) -> RecordingError:
    """
    Return the error of a recording that cannot go on.

    :param path: its folder
    :param setting: what the folder around it was given by
    """
    return RecordingError(
        f'recording to {path} has stopped ({_reason(error)}): {_way_out(error, setting)}, and '
        'start a new one')


def _reason(error: Exception) -> str:
    return getattr(error, 'strerror', None) or str(error) or type(error).__name__


def _way_out(error: Exception, setting: str) -> str:
    if isinstance(error, FileChangedError):
        return 'leave the folder of a recording alone while it is written'
    number = getattr(error, 'errno', None)
    if number in _NO_ROOM:
        return f'free disk space, or set {setting} to another disk'
    if number in _TOO_MANY_FILES:
        return 'raise the limit of open files (ulimit -n), or close some'
    # Python reports a thread that the system refuses as a RuntimeError.
    if number in _USED_UP or isinstance(error, (RuntimeError, MemoryError)):
        return 'close other programs, or raise the limits of memory and processes (ulimit -a)'
    return f'set {setting} to a writable folder'
