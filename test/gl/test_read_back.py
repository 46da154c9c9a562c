# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is read in two parts is what the buffers held in between, and takes memory when asked."""

from collections.abc import Iterator

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.gl.read_back import ReadBack
import numpy as np
import pytest


@pytest.fixture(scope='module', autouse=True)
def context() -> Iterator[Context]:
    """Make a context for all tests."""
    made = Context(single_thread=True)
    yield made
    made.close()


def values(count: int, first: int = 0) -> np.ndarray:
    """Return numbers that identify their source."""
    return np.arange(first, first + count, dtype=np.float32)


def test_what_is_written_later_is_not_read():
    """A frame would show the state of the next one, in part or as a whole."""
    with take_inventory() as inventory:
        buffers = [Buffer(values(64)), Buffer(values(1000, 100))]
        found = [np.empty(64, dtype=np.float32), np.empty(900, dtype=np.float32)]
        read_back = ReadBack()
        finish = read_back.begin(list(zip(buffers, found)))
        for buffer in buffers:
            buffer.write(values(64, 5000))
        finish()
        assert np.array_equal(found[0], values(64))
        assert np.array_equal(found[1], values(900, 100))
        found[0][:] = 7.0
        finish()
        assert np.all(found[0] == 7.0), 'it has been finished'
        read_back.delete()
        for buffer in buffers:
            buffer.delete()
        assert not inventory.buffers


def test_what_is_begun_anew_or_given_back_is_finished_first():
    """The memory would be written over, or be gone, before it has been read."""
    buffer = Buffer(values(32))
    first, second = np.empty(32, dtype=np.float32), np.empty(32, dtype=np.float32)
    read_back = ReadBack()
    finish_first = read_back.begin([(buffer, first)])
    buffer.write(values(32, 100))
    finish_second = read_back.begin([(buffer, second)])
    buffer.delete()
    read_back.delete()
    for finish in (finish_second, finish_first):
        finish()
    assert np.array_equal(first, values(32))
    assert np.array_equal(second, values(32, 100))


def test_a_context_beside_finishes_what_another_has_begun(context: Context):
    """After a mode switch, which may change the context, a frame would be lost."""
    buffer, found = Buffer(values(32)), np.empty(32, dtype=np.float32)
    read_back = ReadBack()
    finish = read_back.begin([(buffer, found)])
    context.finish()
    beside = Context(beside=context)
    finish()
    assert np.array_equal(found, values(32))
    beside.close()
    context.make_current()
    read_back.delete()
    buffer.delete()


def test_memory_is_allocated_once_and_grows():
    """Each frame would allocate anew, or a larger reading would leave its memory."""
    small, large = Buffer(values(16)), Buffer(values(64))
    with take_inventory() as inventory:
        read_back = ReadBack()
        assert not inventory.buffers
        for buffer, count, most in ((small, 16, 16), (large, 64, 64), (small, 16, 64)) * 2:
            found = np.empty(count, dtype=np.float32)
            read_back.begin([(buffer, found)])()
            assert np.array_equal(found, values(count))
            assert len(inventory.buffers) == 1 and inventory.buffer_bytes >= 4 * most
        read_back.delete()
        assert not inventory.buffers
    small.delete()
    large.delete()
