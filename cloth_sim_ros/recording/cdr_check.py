# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Whether the lengths within a CDR message fit its bytes, found without building the message.

A reader that is sent a forged length allocates what it says, up to gigabytes, or drops the
message with an error of its middleware. Elements of lists are counted, not visited, where all of
them take the same number of bytes: a cloud of a million nodes is checked in microseconds.
"""

from collections.abc import Callable
import struct
from typing import Any

from rosbags.interfaces import Nodetype
from rosbags.typesys.store import Typestore

# Bytes of the header in front of a CDR message.
_HEADER = 4
# In bytes; each is aligned to its size.
_SIZES = {
    'bool': 1, 'byte': 1, 'char': 1, 'octet': 1, 'int8': 1, 'uint8': 1, 'int16': 2, 'uint16': 2,
    'int32': 4, 'uint32': 4, 'float32': 4, 'int64': 8, 'uint64': 8, 'float64': 8}
_LARGEST_ALIGNMENT = 8
# Returns where a value ends that begins at an offset from the end of the header.
_Walk = Callable[['_Bytes', int], int]


class _Bytes:
    """The bytes behind the header of a message."""

    def __init__(self, data: bytes | memoryview) -> None:
        """Take the byte order from the header."""
        self.size = len(data) - _HEADER
        if self.size < 0:
            raise ValueError(f'has {len(data)} bytes, fewer than the {_HEADER} of its header')
        if data[0] != 0 or data[1] > 1:
            raise ValueError(f'begins with {bytes(data[:2]).hex()}, which is not plain CDR')
        self._data = data
        self._length = struct.Struct('<I' if data[1] else '>I')

    def length(self, offset: int) -> tuple[int, int]:
        """Return a length, and where it ends."""
        offset = self.within(_aligned(offset, 4) + 4)
        return self._length.unpack_from(self._data, offset - 4 + _HEADER)[0], offset

    def within(self, offset: int) -> int:
        """Return ``offset``, which a message must not go beyond."""
        if offset > self.size:
            raise ValueError(
                f'has a length that needs {offset} bytes, and {self.size} are there')
        return offset


class CdrCheck:
    """
    Checks messages of one type.

    :param store: that knows the type and those in it
    :param name: such as sensor_msgs/msg/PointCloud2
    """

    def __init__(self, store: Typestore, name: str) -> None:
        """Find out how its parts are laid out."""
        self._store = store
        self._walks: dict[str, _Walk] = {}
        self._walk = self._of_message(name)

    def check(self, data: bytes | memoryview) -> None:
        """Raise ValueError, saying what is wrong, unless all lengths are within ``data``."""
        self._walk(_Bytes(data), 0)

    def _of_message(self, name: str) -> _Walk:
        if name not in self._walks:
            _, fields = self._store.fielddefs[name]
            # Types that contain themselves do not exist.
            walks = [self._of_field(kind, parts) for _, (kind, parts) in fields]
            self._walks[name] = _in_turn(walks)
        return self._walks[name]

    def _of_field(self, kind: Nodetype, parts: Any) -> _Walk:
        if kind == Nodetype.BASE:
            return _string if parts[0] == 'string' else _of_size(_SIZES[parts[0]])
        if kind == Nodetype.NAME:
            return self._of_message(parts)
        element, count = parts
        walk, table = self._of_field(*element), self._advances(*element)
        if kind == Nodetype.ARRAY:
            return lambda data, offset: _repeated(data, offset, count, walk, table)

        def sequence(data: _Bytes, offset: int) -> int:
            length, offset = data.length(offset)
            return _repeated(data, offset, length, walk, table)

        return sequence

    def _advances(self, kind: Nodetype, parts: Any) -> list[int] | None:
        """Return how many bytes an element takes at each alignment; None where that varies."""
        if not self._is_fixed(kind, parts):
            return None
        endless = _Bytes(bytes(_HEADER))
        endless.size = 1 << 62
        walk = self._of_field(kind, parts)
        return [walk(endless, at) - at for at in range(_LARGEST_ALIGNMENT)]

    def _is_fixed(self, kind: Nodetype, parts: Any) -> bool:
        if kind == Nodetype.BASE:
            return parts[0] != 'string'
        if kind == Nodetype.NAME:
            return all(self._is_fixed(*field) for _, field in self._store.fielddefs[parts][1])
        return kind == Nodetype.ARRAY and self._is_fixed(*parts[0])


def _aligned(offset: int, size: int) -> int:
    return -(-offset // size) * size


def _of_size(size: int) -> _Walk:
    return lambda data, offset: data.within(_aligned(offset, size) + size)


def _string(data: _Bytes, offset: int) -> int:
    length, offset = data.length(offset)
    return data.within(offset + length)


def _in_turn(walks: list[_Walk]) -> _Walk:
    def walk(data: _Bytes, offset: int) -> int:
        for each in walks:
            offset = each(data, offset)
        return offset

    return walk


def _repeated(
        data: _Bytes, offset: int, count: int, walk: _Walk, advances: list[int] | None) -> int:
    # An element of any type takes a byte or more.
    data.within(offset + count)
    if advances is None:
        for _ in range(count):
            offset = walk(data, offset)
        return offset
    seen: dict[int, tuple[int, int]] = {}  # number and offset of an element, by its alignment
    number = 0
    while number < count:
        alignment = offset % _LARGEST_ALIGNMENT
        if alignment in seen:
            # From here on, alignments come round again.
            first, begin = seen[alignment]
            rounds = (count - number) // (number - first)
            offset = data.within(offset + rounds * (offset - begin))
            number += rounds * (number - first)
            seen.clear()
            if number == count:
                break
        seen[alignment] = number, offset
        offset = data.within(offset + advances[alignment])
        number += 1
    return offset
