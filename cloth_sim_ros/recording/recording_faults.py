# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Why a recording cannot begin or go on, or was cut off, with the way out."""

import errno
from pathlib import Path

from cloth_sim_ros.recording.watched_file import FileChangedError
from cloth_sim_ros.sim.errors import ClothSimError

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

    :param finding: what is there in place of a recording, behind the path
    """
    return ClothSimError(
        f'{path} {finding}, as it was truncated before the first flush, within a second of its '
        'start: give another recording, or read it later if it is being recorded')


def refusal(folder: Path, error: Exception, setting: str) -> ClothSimError:
    """
    Return the error of a recording that cannot begin.

    :param folder: that it should have gone into
    :param setting: what ``folder`` was given by
    """
    return ClothSimError(
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
