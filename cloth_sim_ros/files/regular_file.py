# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Open regular files only: no pipe without a writer, no endless device."""

import errno
import os
from pathlib import Path
import stat
from typing import BinaryIO

from cloth_sim_ros.files.errors import ClothSimError
from cloth_sim_ros.files.errors import cut

_KINDS = (
    (stat.S_ISDIR, 'a folder'), (stat.S_ISFIFO, 'a named pipe'), (stat.S_ISSOCK, 'a socket'),
    (stat.S_ISCHR, 'a device'), (stat.S_ISBLK, 'a device'))


def open_regular(path: str | Path, limit: int | None = None) -> BinaryIO:
    """
    Open the regular file at ``path`` to read its bytes.

    :param limit: largest size it may have [bytes]; None for any
    :raises OSError: when it is not there, or may not be read
    :raises ClothSimError: when it is no regular file, or too large
    """
    try:
        # Without O_NONBLOCK, a pipe that nobody writes into would never be open.
        number = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
    except ValueError as error:  # a name that no file can have
        raise OSError(errno.EINVAL, os.strerror(errno.EINVAL), str(path)) from error
    try:
        status = os.fstat(number)
        for is_kind, name in _KINDS:
            if is_kind(status.st_mode):
                raise ClothSimError(
                    f'{cut(path)} is {name}, and only regular files are read: copy its contents '
                    'into a file, and give that')
        if limit is not None and status.st_size > limit:
            raise _too_large(path, status.st_size, limit)
        return os.fdopen(number, 'rb')
    except BaseException:
        os.close(number)
        raise


def read_regular(path: str | Path, limit: int) -> bytes:
    """
    Return all bytes of the regular file at ``path``.

    :param limit: largest size it may have [bytes]
    :raises OSError: when it is not there, or may not be read
    :raises ClothSimError: when it is no regular file, or too large
    """
    with open_regular(path, limit) as file:
        content = file.read(limit + 1)
    if len(content) > limit:  # files of the kernel say that they have no size
        raise _too_large(path, len(content), limit)
    return content


def is_regular(path: str | Path) -> bool:
    """Return whether there is a regular file at ``path``; it need not be a name at all."""
    try:
        return stat.S_ISREG(os.stat(path).st_mode)
    except (OSError, ValueError):
        return False


def is_folder(path: str | Path) -> bool:
    """Return whether there is a folder at ``path``; it need not be a name at all."""
    try:
        return stat.S_ISDIR(os.stat(path).st_mode)
    except (OSError, ValueError):
        return False


def _too_large(path: str | Path, size: int, limit: int) -> ClothSimError:
    return ClothSimError(
        f'{cut(path)} has {size} bytes, the limit for its kind is {limit}: give another one, or '
        'split it')
