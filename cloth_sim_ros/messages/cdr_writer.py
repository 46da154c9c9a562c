# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Little-endian CDR, for messages too large to go through one Python object per point."""

import struct

import numpy as np

ENCAPSULATION = b'\x00\x01\x00\x00'
_SIZES = {'B': 1, '?': 1, 'i': 4, 'I': 4, 'f': 4, 'q': 8, 'd': 8}


class CdrWriter:
    """Puts fields one behind the other, each aligned to its own size."""

    def __init__(self) -> None:
        """Start an empty message."""
        self._parts: list[bytes | memoryview] = [ENCAPSULATION]
        self._size = 0  # alignment counts from behind the encapsulation

    def put(self, code: str, *values: float) -> None:
        """Put numbers of one struct ``code``."""
        self._align(_SIZES[code])
        self._append(struct.pack(f'<{len(values)}{code}', *values))

    def put_string(self, text: str) -> None:
        """Put a string."""
        data = text.encode() + b'\x00'
        self.put('I', len(data))
        self._append(data)

    def put_bytes(self, data: bytes | memoryview, alignment: int) -> None:
        """Put fields that are in CDR already, the first of them aligned to ``alignment``."""
        self._align(alignment)
        self._append(data)

    def put_sequence(self, array: np.ndarray) -> None:
        """Put a sequence whose elements are the rows of ``array``, of one little-endian type."""
        self.put('I', len(array))
        if len(array):
            self._align(array.dtype.itemsize)
            self._append(np.ascontiguousarray(array).data.cast('B'))

    def finish(self) -> bytes:
        """Return the message."""
        return b''.join(self._parts)

    def _align(self, size: int) -> None:
        padding = -self._size % size
        if padding:
            self._append(bytes(padding))

    def _append(self, data: bytes | memoryview) -> None:
        self._parts.append(data)
        self._size += len(data)
