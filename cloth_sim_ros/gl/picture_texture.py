# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A picture that shaders take colours from, at any size."""

from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.libraries import GL
import numpy as np


class PictureTexture:
    """
    A picture with all its halves, quarters and so on (mipmaps).

    :param pixels: (height, width, 3) uint8; the first line is at 0 of the second coordinate
    :raises DeviceError: when the device has no texture so large
    """

    def __init__(self, pixels: np.ndarray) -> None:
        """Write it to the device."""
        height, width = pixels.shape[:2]
        most = int(GL.glGetIntegerv(GL.GL_MAX_TEXTURE_SIZE))
        if max(width, height) > most:
            raise DeviceError(
                f'a picture of {width} x {height} pixels is too large for this device: use at '
                f'most {most} per side')
        self._texture = int(GL.glGenTextures(1))
        GL.glBindTexture(GL.GL_TEXTURE_2D, self._texture)
        GL.glPixelStorei(GL.GL_UNPACK_ALIGNMENT, 1)
        GL.glTexImage2D(
            GL.GL_TEXTURE_2D, 0, GL.GL_RGB8, width, height, 0, GL.GL_RGB, GL.GL_UNSIGNED_BYTE,
            np.ascontiguousarray(pixels))
        GL.glGenerateMipmap(GL.GL_TEXTURE_2D)
        for name, value in (
                (GL.GL_TEXTURE_MIN_FILTER, GL.GL_LINEAR_MIPMAP_LINEAR),
                (GL.GL_TEXTURE_MAG_FILTER, GL.GL_LINEAR),
                (GL.GL_TEXTURE_WRAP_S, GL.GL_CLAMP_TO_EDGE),
                (GL.GL_TEXTURE_WRAP_T, GL.GL_CLAMP_TO_EDGE)):
            GL.glTexParameteri(GL.GL_TEXTURE_2D, name, value)

    def bind(self, unit: int) -> None:
        """Let shaders read it, as the sampler2D of ``unit``."""
        GL.glActiveTexture(GL.GL_TEXTURE0 + unit)
        GL.glBindTexture(GL.GL_TEXTURE_2D, self._texture)

    def delete(self) -> None:
        """Free the memory."""
        GL.glDeleteTextures(1, [self._texture])
