# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A buffer on the device, read by shaders as storage or through a texture."""

from collections.abc import Iterable
from collections.abc import Sequence

from cloth_sim_ros.gl.context import loss_noticed
from cloth_sim_ros.gl.context import refuse_lost_context
from cloth_sim_ros.gl.inventory import drop_buffer
from cloth_sim_ros.gl.inventory import note_buffer
from cloth_sim_ros.gl.libraries import GL
from cloth_sim_ros.gl.quick_calls import activate_texture
from cloth_sim_ros.gl.quick_calls import bind_buffer
from cloth_sim_ros.gl.quick_calls import bind_buffer_base
from cloth_sim_ros.gl.quick_calls import bind_texture
from cloth_sim_ros.gl.quick_calls import Call
from cloth_sim_ros.gl.quick_calls import clear_buffer
from cloth_sim_ros.gl.quick_calls import copy_buffer
from cloth_sim_ros.gl.quick_calls import make
from cloth_sim_ros.gl.quick_calls import memory_barrier
from cloth_sim_ros.gl.quick_calls import multi_bind
from cloth_sim_ros.gl.quick_calls import read_buffer
from cloth_sim_ros.gl.quick_calls import write_buffer
import numpy as np
from OpenGL.GL.ARB.buffer_storage import glBufferStorage

# As plain numbers: PyOpenGL's constants are slower to hand on.
_STORAGE = int(GL.GL_SHADER_STORAGE_BUFFER)
_DISPATCHES = int(GL.GL_DISPATCH_INDIRECT_BUFFER)
_TEXTURE_BUFFER = int(GL.GL_TEXTURE_BUFFER)
_R32UI, _RED_INTEGER = int(GL.GL_R32UI), int(GL.GL_RED_INTEGER)
_UNSIGNED_INT = int(GL.GL_UNSIGNED_INT)
_COPIED, _COPY = int(GL.GL_COPY_READ_BUFFER), int(GL.GL_COPY_WRITE_BUFFER)
_FIRST_UNIT = int(GL.GL_TEXTURE0)
_READS = int(GL.GL_BUFFER_UPDATE_BARRIER_BIT)
_WRITES = GL.GL_SHADER_STORAGE_BARRIER_BIT | GL.GL_TEXTURE_FETCH_BARRIER_BIT
_DISPATCHED = _WRITES | GL.GL_COMMAND_BARRIER_BIT

# By 17 texels a size leaves both kinds that _allocated avoids [bytes].
_PADDING_BYTES = 272
# Larger ones may be as large as a storage block can be.
_LARGEST_PADDED = 2**26


class Buffer:
    """
    Memory on the device.

    Reading and writing raise DeviceError when the context was lost.

    :param data: what it holds at first, or the number of bytes
    :param is_staging: True for memory that the host reads and only ``copy_to`` writes
    :param is_polled: True for a few numbers that shaders write and the host reads within a step:
        they stay in the host's memory. NVIDIA's driver moves other buffers there for each such
        read, and back for the next pass
    """

    def __init__(
            self, data: np.ndarray | int, *, is_staging: bool = False,
            is_polled: bool = False) -> None:
        """Allocate the memory and fill it."""
        self.bytes = data if isinstance(data, int) else data.nbytes
        content = None if isinstance(data, int) else np.ascontiguousarray(data)
        self.name = int(GL.glGenBuffers(1))
        self._texture: int | None = None
        # True after a fill or a copy into it, until a later write from the host.
        self._is_filled = False
        GL.glBindBuffer(GL.GL_SHADER_STORAGE_BUFFER, self.name)
        if is_polled and glBufferStorage:
            glBufferStorage(
                GL.GL_SHADER_STORAGE_BUFFER, _allocated(self.bytes), None,
                GL.GL_DYNAMIC_STORAGE_BIT | GL.GL_CLIENT_STORAGE_BIT)
        else:
            GL.glBufferData(
                GL.GL_SHADER_STORAGE_BUFFER, _allocated(self.bytes), None,
                GL.GL_STREAM_READ if is_staging else GL.GL_DYNAMIC_COPY)
        if content is not None:
            GL.glBufferSubData(GL.GL_SHADER_STORAGE_BUFFER, 0, self.bytes, content)
        note_buffer(self)

    def bind_storage(self, binding: int) -> None:
        """Let shaders reach it as the storage block ``binding``."""
        bind_buffer_base(_STORAGE, binding, self.name)

    def bind_texture(self, unit: int) -> int:
        """
        Let shaders read it, four floats a texel, as the samplerBuffer of ``unit``.

        :return: the name of its texture
        """
        activate_texture(_FIRST_UNIT + unit)
        if self._texture is None:
            self._texture = int(GL.glGenTextures(1))
            GL.glBindTexture(GL.GL_TEXTURE_BUFFER, self._texture)
            GL.glTexBuffer(GL.GL_TEXTURE_BUFFER, GL.GL_RGBA32F, self.name)
        else:
            bind_texture(_TEXTURE_BUFFER, self._texture)
        return self._texture

    def storage_call(self, binding: int) -> Call:
        """Return the call that ``bind_storage`` makes."""
        return bind_buffer_base, (_STORAGE, binding, self.name)

    def texture_calls(self, unit: int) -> list[Call]:
        """Return the calls that ``bind_texture`` makes."""
        texture = self.bind_texture(unit)
        return [
            (activate_texture, (_FIRST_UNIT + unit,)), (bind_texture, (_TEXTURE_BUFFER, texture))]

    def dispatches_call(self) -> Call:
        """Return the call that ``bind_dispatches`` makes."""
        return bind_buffer, (_DISPATCHES, self.name)

    def bind_dispatches(self) -> None:
        """Let indirect dispatches take their workgroups from it."""
        bind_buffer(_DISPATCHES, self.name)

    def write(self, data: np.ndarray, offset: int = 0) -> None:
        """Overwrite the bytes from ``offset`` on with ``data``."""
        content = np.ascontiguousarray(data)
        self._finish_fill()
        memory_barrier(_READS)
        bind_buffer(_STORAGE, self.name)
        write_buffer(_STORAGE, offset, content.nbytes, content.ctypes.data)
        refuse_lost_context()

    def write_calls(self, data: np.ndarray, offset: int = 0) -> list[Call]:
        """Return the calls that overwrite its bytes with ``data``, which has to be kept."""
        return [
            (memory_barrier, (_READS,)), (bind_buffer, (_STORAGE, self.name)),
            (write_buffer, (_STORAGE, offset, data.nbytes, data.ctypes.data))]

    def clear(self) -> None:
        """Make all of it zero."""
        with loss_noticed():
            GL.glBindBuffer(GL.GL_SHADER_STORAGE_BUFFER, self.name)
            GL.glClearBufferData(
                GL.GL_SHADER_STORAGE_BUFFER, GL.GL_R32UI, GL.GL_RED_INTEGER, GL.GL_UNSIGNED_INT,
                None)
        self._is_filled = True

    def clear_first(self, size: int) -> None:
        """Make the first ``size`` bytes zero."""
        make(self.clear_calls(0, size))

    def clear_calls(self, offset: int, size: int) -> list[Call]:
        """Return the calls that make ``size`` bytes from ``offset`` on zero."""
        self._is_filled = True
        return [
            (memory_barrier, (_READS,)), (bind_buffer, (_STORAGE, self.name)),
            (clear_buffer, (_STORAGE, _R32UI, offset, size, _RED_INTEGER, _UNSIGNED_INT, 0))]

    def copy(self, begin: int, into: int, size: int) -> None:
        """Copy ``size`` bytes from ``begin`` to ``into``; the two parts have to lie apart."""
        memory_barrier(_READS)
        bind_buffer(_STORAGE, self.name)
        copy_buffer(_STORAGE, _STORAGE, begin, into, size)
        self._is_filled = True
        refuse_lost_context()

    def copy_to(self, other: 'Buffer', into: int, size: int, begin: int = 0) -> None:
        """Copy ``size`` bytes from ``begin`` on into ``other``, from its byte ``into`` on."""
        memory_barrier(_READS)
        bind_buffer(_COPIED, self.name)
        bind_buffer(_COPY, other.name)
        copy_buffer(_COPIED, _COPY, begin, into, size)
        other._is_filled = True
        refuse_lost_context()

    def read_into(self, target: np.ndarray, offset: int = 0) -> None:
        """Fill ``target`` (contiguous) with the bytes from ``offset`` on."""
        memory_barrier(_READS)
        bind_buffer(_STORAGE, self.name)
        read_buffer(_STORAGE, offset, target.nbytes, target.ctypes.data)
        refuse_lost_context()

    def read_calls(self, target: np.ndarray) -> list[Call]:
        """Return the calls that fill ``target``, which has to be kept, with its first bytes."""
        return [
            (memory_barrier, (_READS,)), (bind_buffer, (_STORAGE, self.name)),
            (read_buffer, (_STORAGE, 0, target.nbytes, target.ctypes.data))]

    def delete(self) -> None:
        """Free the memory."""
        if self._texture is not None:
            GL.glDeleteTextures(1, [self._texture])
        GL.glDeleteBuffers(1, [self.name])
        drop_buffer(self)

    def _finish_fill(self) -> None:
        """
        Finish a fill of it or a copy into it, if there was one, ahead of a write from the host.

        NVIDIA's driver (580.159) does not keep their order: a fill or a copy overwrites what was
        written after it, in some runs after a flush, too. Dispatches keep theirs.
        """
        if self._is_filled:
            GL.glFinish()
            self._is_filled = False


def _allocated(size: int) -> int:
    """
    Return the bytes to allocate for ``size``: some sizes get a few texels more.

    llvmpipe compiles a shader anew, in the midst of a run, where a buffer that it reads as a
    texture turns into one of a size that is a power of two, or whose bits 8 to 15 are zero (Mesa
    takes them for the last level of an image), or is none of these any more.
    """
    while size <= _LARGEST_PADDED and (size & (size - 1) == 0 or size & 0xFF00 == 0):
        size += _PADDING_BYTES
    return size


class BufferRow:
    """
    Buffers that stand in a row of bindings, bound in one call where the driver has it (GL 4.4).

    :param buffers: in the order of their bindings
    """

    def __init__(self, buffers: Iterable[Buffer]) -> None:
        """Remember them; nothing is bound."""
        self._buffers = tuple(buffers)
        self._calls = multi_bind()
        self._names = _Names([buffer.name for buffer in self._buffers])
        self._textures: _Names | None = None

    def bind_storage(self, first: int) -> None:
        """Let shaders reach them as the storage blocks from ``first`` on."""
        if self._calls is None:
            for binding, buffer in enumerate(self._buffers, first):
                buffer.bind_storage(binding)
        else:
            self._calls.bind_buffers(
                _STORAGE, first, len(self._buffers), self._names.address)

    def storage_calls(self, first: int) -> list[Call]:
        """Return the calls that ``bind_storage`` makes."""
        if self._calls is None:
            return [
                buffer.storage_call(place) for place, buffer in enumerate(self._buffers, first)]
        return [(self._calls.bind_buffers, (
            _STORAGE, first, len(self._buffers), self._names.address))]

    def texture_calls(self, first: int) -> list[Call]:
        """Return the calls that ``bind_textures`` makes."""
        self.bind_textures(first)
        if self._calls is None or self._textures is None:
            return [
                call for unit, buffer in enumerate(self._buffers, first)
                for call in buffer.texture_calls(unit)]
        return [(
            self._calls.bind_textures, (first, len(self._buffers), self._textures.address))]

    def bind_textures(self, first: int) -> None:
        """Let shaders read them as the samplerBuffers of the units from ``first`` on."""
        if self._calls is None or self._textures is None:
            self._textures = _Names(
                [buffer.bind_texture(unit) for unit, buffer in enumerate(self._buffers, first)])
        else:
            self._calls.bind_textures(first, len(self._buffers), self._textures.address)


class _Names:
    # As the driver reads them. An address requested each time would take longer than the call.
    def __init__(self, names: Sequence[int]) -> None:
        self._values = np.array(names, dtype=np.uint32)
        self.address: int = self._values.ctypes.data


def most_bytes() -> int:
    """Return how large a buffer shaders of this device can reach."""
    return int(GL.glGetIntegerv(GL.GL_MAX_SHADER_STORAGE_BLOCK_SIZE))


def shader_writes_visible() -> None:
    """Order all reads by later dispatches after the writes of earlier ones."""
    memory_barrier(_WRITES)


def shader_dispatches_visible() -> None:
    """Order all indirect dispatches to come after the writes of earlier ones, too."""
    memory_barrier(_DISPATCHED)


def writes_visible_call() -> Call:
    """Return the call that ``shader_writes_visible`` makes."""
    return memory_barrier, (_WRITES,)


def dispatches_visible_call() -> Call:
    """Return the call that ``shader_dispatches_visible`` makes."""
    return memory_barrier, (_DISPATCHED,)
