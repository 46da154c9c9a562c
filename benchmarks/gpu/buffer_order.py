# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Writes, fills, copies and dispatches take effect in the order in which they are called.

NVIDIA's driver 580.159 let a fill overwrite a later write from the host (gl/buffer.py).
"""

from collections.abc import Callable
from collections.abc import Iterator

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.libraries import GL
from gpu.kernel import ADD
from gpu.kernel import compiled
from gpu.kernel import LOCAL
from gpu.section import FAULT
from gpu.section import Row
from gpu.section import Section
import numpy as np

_REPEATS = 20


class _Adder:
    """Adds a number to all values of a buffer by a dispatch."""

    def __init__(self) -> None:
        self._program = compiled(ADD)
        self._term = GL.glGetUniformLocation(self._program, 'term')

    def __call__(self, buffer: Buffer, term: float) -> None:
        GL.glUseProgram(self._program)
        GL.glUniform1f(self._term, term)
        buffer.bind_storage(0)
        GL.glDispatchCompute(buffer.bytes // 4 // LOCAL, 1, 1)
        shader_writes_visible()


def sequences(count: int) -> Iterator[tuple[str, Callable[[], tuple[Buffer, float]]]]:
    """
    Yield sequences of commands on a buffer of ``count`` floats.

    :return: name, and what runs it and returns the buffer with the value that all of it must have
    """
    add = _Adder()
    zeros, hundreds = (np.full(count, value, dtype=np.float32) for value in (0.0, 100.0))
    source = Buffer(zeros)
    size = zeros.nbytes

    def fill_write() -> tuple[Buffer, float]:
        buffer = Buffer(size)
        buffer.clear()
        buffer.write(hundreds)
        return buffer, 100.0

    def copy_write() -> tuple[Buffer, float]:
        buffer = Buffer(size)
        source.copy_to(buffer, 0, size)
        buffer.write(hundreds)
        return buffer, 100.0

    def dispatch_fill_dispatch() -> tuple[Buffer, float]:
        buffer = Buffer(zeros)
        add(buffer, 1.0)
        buffer.clear()
        add(buffer, 2.0)
        return buffer, 2.0

    def dispatch_write_dispatch() -> tuple[Buffer, float]:
        buffer = Buffer(zeros)
        add(buffer, 1.0)
        buffer.write(hundreds)
        add(buffer, 2.0)
        return buffer, 102.0

    def dispatch_copy_dispatch() -> tuple[Buffer, float]:
        buffer = Buffer(hundreds)
        add(buffer, 1.0)
        source.copy_to(buffer, 0, size)
        add(buffer, 2.0)
        return buffer, 2.0

    def fill_dispatch_write() -> tuple[Buffer, float]:
        buffer = Buffer(size)
        buffer.clear()
        add(buffer, 1.0)
        buffer.write(hundreds)
        return buffer, 100.0

    for sequence in (
            fill_write, copy_write, dispatch_fill_dispatch, dispatch_write_dispatch,
            dispatch_copy_dispatch, fill_dispatch_write):
        yield sequence.__name__.replace('_', ', '), sequence


def _measure(quick: bool) -> Iterator[Row]:
    context = Context()
    for count in (64, 4096) if quick else (64, 4096, 2**20):
        for name, run in sequences(count):
            wrong = 0
            for _ in range(_REPEATS):
                buffer, value = run()
                found = np.empty(count, dtype=np.float32)
                buffer.read_into(found)
                wrong += bool((found != value).any())
                buffer.delete()
            yield {'sequence': name, 'floats': count, 'wrong': wrong, 'of': _REPEATS,
                   FAULT: 'order not kept' if wrong else ''}
    context.close()


SECTION = Section('buffer_order', 'Order of buffer commands', 20.0, _measure)
