# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Numbers are drawn without a window and read back as they are."""

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.value_images import BYTES
from cloth_sim_ros.gl.value_images import FLOATS
from cloth_sim_ros.gl.value_images import FOUR_FLOATS
from cloth_sim_ros.gl.value_images import ValueImages
import numpy as np
from OpenGL import GL
import pytest


@pytest.fixture(autouse=True)
def context():
    """Make a context, and give it back."""
    context = Context()
    yield context
    context.close()


def test_where_nothing_is_drawn_is_what_was_begun_with():
    """An empty picture would look like a wall."""
    images = ValueImages(37, 21, [FLOATS, BYTES, FOUR_FLOATS])
    images.begin((np.inf, 200, np.nan))
    depth, labels, normals = (images.read(number) for number in range(3))
    assert depth.shape == labels.shape == (21, 37) and normals.shape == (21, 37, 4)
    assert depth.dtype == normals.dtype == np.float32 and labels.dtype == np.uint8
    assert np.isposinf(depth).all() and (labels == 200).all() and np.isnan(normals).all()
    images.delete()


def test_the_lowest_line_comes_first():
    """A picture would be upside down."""
    images = ValueImages(8, 4, [FLOATS])
    images.begin((1.0,))
    GL.glEnable(GL.GL_SCISSOR_TEST)
    GL.glScissor(4, 1, 4, 1)
    GL.glClearBufferfv(GL.GL_COLOR, 0, np.full(4, 0.1, np.float32))
    GL.glDisable(GL.GL_SCISSOR_TEST)
    expected = np.ones((4, 8), np.float32)
    expected[1, 4:] = np.float32(0.1)
    np.testing.assert_array_equal(images.read(0), expected)
    images.delete()


def test_a_picture_too_large_for_the_device_is_refused():
    """The device would fail in a place that says nothing about pictures."""
    with pytest.raises(DeviceError, match='1000000 x 8 pixels is too large .* use at most'):
        ValueImages(1_000_000, 8, [FLOATS])
