# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How far away what is drawn is, without colours."""

from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.libraries import GL
import numpy as np


class DepthBuffer:
    """
    Depth of ``width`` x ``height`` pixels, to draw into and read back; one sample each.

    A mean of several, as for colours, would be a depth that nothing has at an outline.

    :raises DeviceError: when the device has no picture so large
    """

    def __init__(self, width: int, height: int) -> None:
        """Allocate the memory."""
        most = int(GL.glGetIntegerv(GL.GL_MAX_RENDERBUFFER_SIZE))
        if max(width, height) > most:
            raise DeviceError(
                f'a depth picture of {width} x {height} pixels is too large for this device: use '
                f'at most {most} per side')
        self.width, self.height = width, height
        self._framebuffer = int(GL.glGenFramebuffers(1))
        self._buffer = int(GL.glGenRenderbuffers(1))
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self._framebuffer)
        GL.glBindRenderbuffer(GL.GL_RENDERBUFFER, self._buffer)
        GL.glRenderbufferStorage(
            GL.GL_RENDERBUFFER, GL.GL_DEPTH_COMPONENT32F, width, height)
        GL.glFramebufferRenderbuffer(
            GL.GL_FRAMEBUFFER, GL.GL_DEPTH_ATTACHMENT, GL.GL_RENDERBUFFER, self._buffer)
        GL.glDrawBuffer(GL.GL_NONE)
        GL.glReadBuffer(GL.GL_NONE)
        status = GL.glCheckFramebufferStatus(GL.GL_FRAMEBUFFER)
        if status != GL.GL_FRAMEBUFFER_COMPLETE:
            raise DeviceError(
                f'the device cannot render a depth picture of {width} x {height} pixels '
                f'({status:#x}): give a smaller size')

    def begin(self) -> None:
        """Direct drawing here, with nothing drawn yet."""
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self._framebuffer)
        GL.glViewport(0, 0, self.width, self.height)
        GL.glDepthMask(GL.GL_TRUE)
        GL.glClear(GL.GL_DEPTH_BUFFER_BIT)

    def read(self) -> np.ndarray:
        """
        Return what was drawn, the uppermost line first.

        :return: (height, width) float32, 0 at the near end, 1 at the far one and where nothing is
        """
        GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, self._framebuffer)
        depths = np.empty((self.height, self.width), np.float32)
        GL.glPixelStorei(GL.GL_PACK_ALIGNMENT, 4)
        GL.glReadPixels(
            0, 0, self.width, self.height, GL.GL_DEPTH_COMPONENT, GL.GL_FLOAT, depths)
        return np.ascontiguousarray(depths[::-1])

    def delete(self) -> None:
        """Give the memory back."""
        GL.glDeleteFramebuffers(1, [self._framebuffer])
        GL.glDeleteRenderbuffers(1, [self._buffer])
