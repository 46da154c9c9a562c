# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Depths are drawn without a window and read back as they are."""

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.framebuffer import DepthBuffer
import numpy as np
from OpenGL import GL
import pytest


@pytest.fixture(autouse=True)
def context():
    """Make a context, and give it back."""
    context = Context()
    yield context
    context.close()


def test_where_nothing_is_drawn_it_is_one():
    """An empty picture would look like a wall."""
    depths = DepthBuffer(37, 21)
    depths.begin()
    seen = depths.read()
    assert seen.shape == (21, 37) and seen.dtype == np.float32
    assert (seen == 1.0).all()
    depths.delete()


def test_the_uppermost_line_comes_first():
    """A picture would be upside down."""
    depths = DepthBuffer(8, 4)
    depths.begin()
    GL.glEnable(GL.GL_SCISSOR_TEST)
    # GL counts from below: this is the third line from the top, in the right half.
    GL.glScissor(4, 1, 4, 1)
    GL.glClearDepth(0.25)
    GL.glClear(GL.GL_DEPTH_BUFFER_BIT)
    GL.glClearDepth(1.0)
    GL.glDisable(GL.GL_SCISSOR_TEST)
    expected = np.ones((4, 8))
    expected[2, 4:] = 0.25
    np.testing.assert_array_equal(depths.read(), expected)


def test_what_was_drawn_before_is_gone():
    """A cloth that has moved on would leave a trace."""
    depths = DepthBuffer(4, 4)
    depths.begin()
    GL.glClearDepth(0.5)
    GL.glClear(GL.GL_DEPTH_BUFFER_BIT)
    GL.glClearDepth(1.0)
    assert (depths.read() == 0.5).all()
    depths.begin()
    assert (depths.read() == 1.0).all()


def test_a_picture_too_large_for_the_device_is_refused():
    """A user would get a GL error code."""
    with pytest.raises(DeviceError, match='1000000 x 8 pixels is too large.*at most'):
        DepthBuffer(1_000_000, 8)
