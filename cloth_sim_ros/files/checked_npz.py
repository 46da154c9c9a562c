# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Read npz files that may be hostile: declared sizes are checked before allocation."""

import math
from pathlib import Path
import struct
import tokenize
from typing import cast
from typing import IO
import warnings
import zipfile
import zlib

from cloth_sim_ros.files.errors import ClothSimError
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.regular_file import open_regular
import numpy as np

MOST_ARRAYS = 64
# Max. declared size of all arrays: _SPARE [bytes] plus _GAIN [1] times the size of the file.
_SPARE = 64 << 20
_GAIN = 64

_KINDS = 'biufSU'
_BLOCK = 1 << 20
_HEADERS = {
    (1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
# Exceptions of numpy, zipfile and zlib on damaged files; zipfile raises NotImplementedError on
# unknown features.
_BROKEN = (
    EOFError, KeyError, NotImplementedError, OverflowError, RuntimeError, SyntaxError, TypeError,
    ValueError, MemoryError, struct.error, tokenize.TokenError, zipfile.BadZipFile, zlib.error)


def load_arrays(path: str | Path, what: str, way_out: str) -> dict[str, np.ndarray]:
    """
    Return the arrays of numbers or words in the npz file at ``path``, by name.

    :param what: the file should be, for errors
    :param way_out: how to get a right one, for errors
    :raises OSError: when it is not there, or may not be read
    :raises ClothSimError: when it is no npz file, has arrays of anything else, or declares more
        than it holds
    """
    with open_regular(path) as file, warnings.catch_warnings():
        warnings.simplefilter('ignore')  # of numpy, on headers in odd forms
        try:
            with zipfile.ZipFile(file) as archive:
                return _arrays(archive, file.seek(0, 2))
        except (*_BROKEN, OSError) as error:  # of a file that is open, OSError is a wrong offset
            reason = cut(error) or type(error).__name__
            raise ClothSimError(
                f'{cut(path)} is not a {what} ({reason}): {way_out}') from error


def _arrays(archive: zipfile.ZipFile, size: int) -> dict[str, np.ndarray]:
    members = archive.infolist()
    if len(members) > MOST_ARRAYS:
        raise ValueError(f'it has {len(members)} arrays, the maximum is {MOST_ARRAYS}')
    declared = sum(member.file_size for member in members)
    if declared > _SPARE + _GAIN * size:
        raise ValueError(f'it has {size} bytes and declares arrays of {declared}')
    return {member.filename.removesuffix('.npy'): _array(archive, member) for member in members}


def _array(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> np.ndarray:
    label = cut(member.filename, 64)
    if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise ValueError(f'{label} uses a compression that numpy does not')
    with archive.open(member) as stream:
        shape, fortran_order, kind = _header(stream, label)
        count = math.prod(shape)
        length, rest = count * kind.itemsize, member.file_size - stream.tell()
        if length != rest:
            raise ValueError(
                f'{label} of shape {cut(shape, 64)} takes {length} bytes and has {rest}')
        content = _content(cast(zipfile.ZipExtFile, stream), length, label)
        array = np.frombuffer(content, kind, count)
    return array.reshape(shape, order='F' if fortran_order else 'C')


def _content(stream: zipfile.ZipExtFile, length: int, label: str) -> bytearray:
    content = bytearray(length)
    view = memoryview(content)
    place = 0
    while place < length:
        got = stream.readinto(view[place:place + _BLOCK])
        if not got:
            raise ValueError(f'{label} ends after {place} of {length} bytes')
        place += got
    # The end is where the checksum is compared.
    if stream.read(1):
        raise ValueError(f'{label} continues after its {length} bytes')
    return content


def _header(stream: IO[bytes], label: str) -> tuple[tuple[int, ...], bool, np.dtype]:
    version = np.lib.format.read_magic(stream)
    if version not in _HEADERS:
        raise ValueError(f'{label} has the unknown version {version}')
    shape, fortran_order, kind = _HEADERS[version](stream)
    if kind.kind not in _KINDS or kind.subdtype is not None or not kind.itemsize:
        raise ValueError(f'{label} holds {cut(kind, 64)}, neither numbers nor strings')
    if not all(0 <= side for side in shape):
        raise ValueError(f'{label} has the shape {cut(shape, 64)}')
    return shape, fortran_order, kind
