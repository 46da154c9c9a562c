# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A picture is drawn without a window and read back as it is."""

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.framebuffer import Framebuffer
import numpy as np
from OpenGL import GL
import pytest


@pytest.fixture(autouse=True)
def context():
    """Make a context, and give it back."""
    context = Context()
    yield context
    context.close()


@pytest.mark.parametrize('detail', [1, 2])
def test_the_background_fills_the_picture(detail):
    """A picture would be black, or have a border."""
    framebuffer = Framebuffer(37, 21, detail)
    framebuffer.begin((1.0, 0.2, 0.0))
    image = framebuffer.read()
    assert image.shape == (21, 37, 3)
    assert (image == (255, 51, 0)).all()


@pytest.mark.parametrize('detail', [1, 2])
def test_the_uppermost_line_comes_first(detail):
    """A picture would be upside down."""
    framebuffer = Framebuffer(8, 4, detail)
    framebuffer.begin((0.0, 0.0, 0.0))
    GL.glEnable(GL.GL_SCISSOR_TEST)
    # GL counts from below: this is the third line from the top, in the right half.
    GL.glScissor(4 * detail, detail, 4 * detail, detail)
    GL.glClearColor(1.0, 1.0, 1.0, 1.0)
    GL.glClear(GL.GL_COLOR_BUFFER_BIT)
    GL.glDisable(GL.GL_SCISSOR_TEST)
    expected = np.zeros((4, 8), np.uint8)
    expected[2, 4:] = 255
    np.testing.assert_array_equal(framebuffer.read()[..., 0], expected)


def test_detail_is_averaged():
    """Twice the detail would be half of the picture, or every other pixel of it."""
    framebuffer = Framebuffer(4, 4, 2)
    framebuffer.begin((0.0, 0.0, 0.0))
    GL.glEnable(GL.GL_SCISSOR_TEST)
    GL.glScissor(0, 0, 8, 1)
    GL.glClearColor(1.0, 1.0, 1.0, 1.0)
    GL.glClear(GL.GL_COLOR_BUFFER_BIT)
    GL.glDisable(GL.GL_SCISSOR_TEST)
    lowest = framebuffer.read()[3, :, 0]
    np.testing.assert_allclose(lowest, 127.5, atol=1.0)


def test_a_picture_too_large_for_the_device_is_refused():
    """A user would get a GL error code."""
    with pytest.raises(DeviceError, match='1000000 x 8 pixels is too large.*at most'):
        Framebuffer(1_000_000, 8)
