# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A picture on the device, without a window, with smooth edges."""

from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.libraries import GL
import numpy as np

_MOST_SAMPLES = 8


class Framebuffer:
    """
    Colour and depth of ``width`` x ``height`` pixels, to draw into and read back.

    Each pixel is the mean of several samples (multisampling), times ``detail`` squared.

    :param detail: 2 draws twice as many pixels along each side and averages them
    :raises DeviceError: when the device has no picture so large
    """

    def __init__(self, width: int, height: int, detail: int = 1) -> None:
        """Allocate the memory."""
        most = int(GL.glGetIntegerv(GL.GL_MAX_RENDERBUFFER_SIZE))
        if max(width, height) * detail > most:
            raise DeviceError(
                f'an image of {width} x {height} pixels is too large for this device: use at most '
                f'{most // detail} per side')
        self.width, self.height, self.detail = width, height, detail
        self.samples = min(int(GL.glGetIntegerv(GL.GL_MAX_SAMPLES)), _MOST_SAMPLES)
        self._buffers: list[int] = []
        self._drawn = self._make(detail, self.samples, with_depth=True)
        self._resolved = self._make(detail, 0)
        self._read = self._make(1, 0) if detail > 1 else self._resolved

    def begin(self, color: tuple[float, float, float]) -> None:
        """Direct drawing here, onto ``color``, red, green, blue from 0 to 1."""
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self._drawn)
        GL.glViewport(0, 0, self.width * self.detail, self.height * self.detail)
        GL.glDepthMask(GL.GL_TRUE)
        GL.glClearColor(*color, 1.0)
        GL.glClear(GL.GL_COLOR_BUFFER_BIT | GL.GL_DEPTH_BUFFER_BIT)

    def read(self) -> np.ndarray:
        """Return what was drawn, (height, width, 3) uint8, the uppermost line first."""
        self._copy(self._drawn, self._resolved, self.detail, GL.GL_NEAREST)
        if self.detail > 1:
            self._copy(self._resolved, self._read, 1, GL.GL_LINEAR)
        GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, self._read)
        pixels = np.empty((self.height, self.width, 4), np.uint8)
        GL.glPixelStorei(GL.GL_PACK_ALIGNMENT, 1)
        GL.glReadPixels(
            0, 0, self.width, self.height, GL.GL_RGBA, GL.GL_UNSIGNED_BYTE, pixels)
        return np.ascontiguousarray(pixels[::-1, :, :3])

    def delete(self) -> None:
        """Give the memory back."""
        names = {self._drawn, self._resolved, self._read}
        GL.glDeleteFramebuffers(len(names), list(names))
        GL.glDeleteRenderbuffers(len(self._buffers), self._buffers)

    def _copy(self, source: int, target: int, detail: int, how: int) -> None:
        GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, source)
        GL.glBindFramebuffer(GL.GL_DRAW_FRAMEBUFFER, target)
        size = (self.width * self.detail, self.height * self.detail)
        GL.glBlitFramebuffer(
            0, 0, *size, 0, 0, self.width * detail, self.height * detail,
            GL.GL_COLOR_BUFFER_BIT, how)

    def _make(self, detail: int, samples: int, with_depth: bool = False) -> int:
        framebuffer = int(GL.glGenFramebuffers(1))
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, framebuffer)
        parts = [(GL.GL_COLOR_ATTACHMENT0, GL.GL_RGBA8)]
        if with_depth:
            parts.append((GL.GL_DEPTH_ATTACHMENT, GL.GL_DEPTH_COMPONENT32F))
        for attachment, kind in parts:
            buffer = int(GL.glGenRenderbuffers(1))
            self._buffers.append(buffer)
            GL.glBindRenderbuffer(GL.GL_RENDERBUFFER, buffer)
            GL.glRenderbufferStorageMultisample(
                GL.GL_RENDERBUFFER, samples, kind, self.width * detail, self.height * detail)
            GL.glFramebufferRenderbuffer(
                GL.GL_FRAMEBUFFER, attachment, GL.GL_RENDERBUFFER, buffer)
        status = GL.glCheckFramebufferStatus(GL.GL_FRAMEBUFFER)
        if status != GL.GL_FRAMEBUFFER_COMPLETE:
            raise DeviceError(
                f'the device cannot render an image of {self.width} x {self.height} pixels '
                f'({status:#x}): give a smaller size')
        return framebuffer
