# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Images of numbers that fragment shaders write, with a depth test and one sample a pixel."""

from collections.abc import Sequence
from typing import NamedTuple

from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.libraries import GL
import numpy as np


class ImageKind(NamedTuple):
    """
    The numbers of an image.

    :param stored: format on the device
    :param read: format of the host
    :param channels: numbers of a pixel
    :param kind: of number, in GL
    :param dtype: of one on the host
    """

    stored: int
    read: int
    channels: int
    kind: int
    dtype: type


FLOATS = ImageKind(GL.GL_R32F, GL.GL_RED, 1, GL.GL_FLOAT, np.float32)
BYTES = ImageKind(GL.GL_R8UI, GL.GL_RED_INTEGER, 1, GL.GL_UNSIGNED_BYTE, np.uint8)
FOUR_FLOATS = ImageKind(GL.GL_RGBA32F, GL.GL_RGBA, 4, GL.GL_FLOAT, np.float32)


class ValueImages:
    """
    Images of ``width`` x ``height`` pixels; output k of a shader goes into the k-th.

    A mean of several samples would be a value that nothing has at an outline.

    :param kinds: of the images
    :raises DeviceError: when the device has no picture so large
    """

    def __init__(self, width: int, height: int, kinds: Sequence[ImageKind]) -> None:
        """Allocate the memory."""
        most = int(GL.glGetIntegerv(GL.GL_MAX_RENDERBUFFER_SIZE))
        if max(width, height) > most:
            raise DeviceError(
                f'a picture of {width} x {height} pixels is too large for this device: use at '
                f'most {most} per side')
        self.width, self.height = width, height
        self._kinds = tuple(kinds)
        self._framebuffer = int(GL.glGenFramebuffers(1))
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self._framebuffer)
        self._buffers: list[int] = []
        places = [GL.GL_COLOR_ATTACHMENT0 + k for k in range(len(kinds))]
        for place, stored in zip(
                [*places, GL.GL_DEPTH_ATTACHMENT],
                [*(kind.stored for kind in kinds), GL.GL_DEPTH_COMPONENT32F]):
            buffer = int(GL.glGenRenderbuffers(1))
            self._buffers.append(buffer)
            GL.glBindRenderbuffer(GL.GL_RENDERBUFFER, buffer)
            GL.glRenderbufferStorage(GL.GL_RENDERBUFFER, stored, width, height)
            GL.glFramebufferRenderbuffer(
                GL.GL_FRAMEBUFFER, place, GL.GL_RENDERBUFFER, buffer)
        GL.glDrawBuffers(len(places), places)
        status = GL.glCheckFramebufferStatus(GL.GL_FRAMEBUFFER)
        if status != GL.GL_FRAMEBUFFER_COMPLETE:
            raise DeviceError(
                f'the device cannot render pictures of {width} x {height} pixels ({status:#x}): '
                'give a smaller size')

    def begin(self, values: Sequence[float]) -> None:
        """Direct drawing here; each image has one of ``values`` where nothing is drawn."""
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self._framebuffer)
        GL.glViewport(0, 0, self.width, self.height)
        GL.glDisable(GL.GL_BLEND)
        GL.glDepthMask(GL.GL_TRUE)
        GL.glClearBufferfv(GL.GL_DEPTH, 0, np.ones(1, np.float32))
        for number, (kind, value) in enumerate(zip(self._kinds, values)):
            if kind.dtype is np.uint8:
                GL.glClearBufferuiv(GL.GL_COLOR, number, np.full(4, value, np.uint32))
            else:
                GL.glClearBufferfv(GL.GL_COLOR, number, np.full(4, value, np.float32))

    def read(self, number: int) -> np.ndarray:
        """
        Return what was drawn into an image.

        :return: (height, width), or (height, width, 4) for FOUR_FLOATS, the line with the least
            y of the window first
        """
        kind = self._kinds[number]
        shape = (self.height, self.width, kind.channels)
        values = np.empty(shape if kind.channels > 1 else shape[:2], kind.dtype)
        GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, self._framebuffer)
        GL.glReadBuffer(GL.GL_COLOR_ATTACHMENT0 + number)
        GL.glPixelStorei(GL.GL_PACK_ALIGNMENT, 1)
        GL.glReadPixels(
            0, 0, self.width, self.height, kind.read, kind.kind, values)
        return values

    def delete(self) -> None:
        """Free the memory."""
        GL.glDeleteFramebuffers(1, [self._framebuffer])
        GL.glDeleteRenderbuffers(len(self._buffers), self._buffers)
