# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Buffers return their data, and their size does not require another shader."""

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.libraries import GL
from gpu.buffer_order import sequences
import numpy as np
import pytest


@pytest.fixture(scope='module', autouse=True)
def context():
    """Make a context for all tests."""
    made = Context(single_thread=True)
    yield made
    made.close()


def allocated(buffer):
    """Return the bytes that the driver has allocated."""
    GL.glBindBuffer(GL.GL_SHADER_STORAGE_BUFFER, buffer.name)
    return int(GL.glGetBufferParameteriv(GL.GL_SHADER_STORAGE_BUFFER, GL.GL_BUFFER_SIZE))


@pytest.mark.parametrize('size', [4, 32, 240, 4096, 4112, 65536, 65552, 2**20, 2**20 + 16, 2**26])
def test_no_size_needs_another_shader(size):
    """A buffer that grows in a run would make llvmpipe compile its readers anew: 0.3 s each."""
    buffer = Buffer(size)
    found = allocated(buffer)
    assert found & (found - 1) != 0 and found & 0xFF00 != 0
    assert buffer.bytes == size <= found <= size + 2 * 272
    buffer.delete()


def test_the_largest_storage_block_is_not_exceeded():
    """A cloth as large as the device allows would be refused, or read beyond its buffer."""
    buffer = Buffer(2**27)
    assert allocated(buffer) == 2**27
    buffer.delete()


@pytest.mark.parametrize('count', [4, 7, 1024])
def test_content_is_what_was_given(count):
    """What is more than was asked for would move or replace what was given."""
    given = np.arange(count, dtype=np.float32)
    buffer = Buffer(given)
    found = np.empty_like(given)
    buffer.read_into(found)
    assert np.array_equal(found, given)
    buffer.write(given[::-1])
    buffer.read_into(found)
    assert np.array_equal(found, given[::-1])
    buffer.delete()


@pytest.mark.parametrize('name', [
    'fill, write', 'copy, write', 'dispatch, fill, dispatch', 'dispatch, write, dispatch',
    'dispatch, copy, dispatch', 'fill, dispatch, write'])
def test_commands_take_effect_in_their_order(name: str):
    """A cloth would start from zeros: on an H200, a fill overwrote a later write."""
    buffer, value = dict(sequences(64))[name]()
    found = np.empty(64, dtype=np.float32)
    buffer.read_into(found)
    assert (found == value).all()
    buffer.delete()


def test_a_polled_buffer_holds_what_shaders_write():
    """A solve would go by numbers that are not those of the device."""
    polled = Buffer(np.arange(64, dtype=np.float32), is_polled=True)
    source = Buffer(np.arange(64, 128, dtype=np.float32))
    source.copy_to(polled, 16, 32, begin=8)
    found = np.empty(64, dtype=np.float32)
    polled.read_into(found)
    assert found[:4].tolist() == [0, 1, 2, 3]
    assert found[4:12].tolist() == list(range(66, 74)) and found[12] == 12
    polled.delete()
    source.delete()
