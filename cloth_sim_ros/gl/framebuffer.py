# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Framebuffers without a window, for colours and for depth, and which pixels they keep."""

from collections.abc import Iterator
from contextlib import contextmanager

from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.libraries import GL
import numpy as np

_MOST_SAMPLES = 8


class Framebuffer:
    """
    Colour and depth of ``width`` x ``height`` pixels, to draw into and read back.

    Each pixel is the mean of several samples (multisampling), times ``detail`` squared.

    :param detail: 2 draws twice as many pixels along each side and averages them
    :param most_samples: of a pixel; 1 leaves outlines jagged
    :raises DeviceError: when the device has no picture so large
    """

    def __init__(
            self, width: int, height: int, detail: int = 1,
            most_samples: int = _MOST_SAMPLES) -> None:
        """Allocate the memory."""
        most = int(GL.glGetIntegerv(GL.GL_MAX_RENDERBUFFER_SIZE))
        if max(width, height) * detail > most:
            raise DeviceError(
                f'an image of {width} x {height} pixels is too large for this device: use at most '
                f'{most // detail} per side')
        self.width, self.height, self.detail = width, height, detail
        wanted = min(int(GL.glGetIntegerv(GL.GL_MAX_SAMPLES)), most_samples)
        # One sample is none in GL: some devices make two or more of it.
        self.samples = wanted if wanted > 1 else 0
        self._buffers: list[int] = []
        self._drawn = self._make(detail, self.samples, with_depth=True)
        self._resolved = self._make(detail, 0) if self.samples else self._drawn
        self._read = self._make(1, 0) if detail > 1 else self._resolved

    def begin(self, color: tuple[float, float, float]) -> None:
        """Direct drawing here, onto ``color``, red, green, blue from 0 to 1."""
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self._drawn)
        GL.glViewport(0, 0, self.width * self.detail, self.height * self.detail)
        GL.glDepthMask(GL.GL_TRUE)
        GL.glClearColor(*color, 1.0)
        GL.glClear(GL.GL_COLOR_BUFFER_BIT | GL.GL_DEPTH_BUFFER_BIT)

    def read(self, *, is_upside_down: bool = False) -> np.ndarray:
        """
        Return what was drawn, (height, width, 3) uint8, the uppermost line first.

        :param is_upside_down: True for what was drawn with the uppermost line below
        """
        if self._resolved != self._drawn:
            self._copy(self._drawn, self._resolved, self.detail, GL.GL_NEAREST)
        if self.detail > 1:
            self._copy(self._resolved, self._read, 1, GL.GL_LINEAR)
        GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, self._read)
        pixels = np.empty((self.height, self.width, 3), np.uint8)
        GL.glPixelStorei(GL.GL_PACK_ALIGNMENT, 1)
        GL.glReadPixels(0, 0, self.width, self.height, GL.GL_RGB, GL.GL_UNSIGNED_BYTE, pixels)
        return pixels if is_upside_down else np.ascontiguousarray(pixels[::-1])

    def delete(self) -> None:
        """Free the memory."""
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


class DepthTexture:
    """
    Depth of ``side`` x ``side`` pixels, to draw into and then to compare with in shaders.

    A comparison is the mean of those with the four pixels around a place, or that with the
    nearest one, which takes a fourth of the time on a software device.

    :raises DeviceError: when the device has no texture so large
    """

    def __init__(self, side: int) -> None:
        """Allocate the memory."""
        most = int(GL.glGetIntegerv(GL.GL_MAX_TEXTURE_SIZE))
        if side > most:
            raise DeviceError(
                f'a depth texture of {side} x {side} pixels is too large for this device: use '
                f'at most {most} per side')
        self.side = side
        self._texture = int(GL.glGenTextures(1))
        GL.glBindTexture(GL.GL_TEXTURE_2D, self._texture)
        GL.glTexStorage2D(GL.GL_TEXTURE_2D, 1, GL.GL_DEPTH_COMPONENT32F, side, side)
        self._nearest = int(GL.glGenSamplers(1))
        for name, value in (
                (GL.GL_TEXTURE_WRAP_S, GL.GL_CLAMP_TO_EDGE),
                (GL.GL_TEXTURE_WRAP_T, GL.GL_CLAMP_TO_EDGE),
                (GL.GL_TEXTURE_COMPARE_MODE, GL.GL_COMPARE_REF_TO_TEXTURE),
                (GL.GL_TEXTURE_COMPARE_FUNC, GL.GL_LEQUAL)):
            GL.glTexParameteri(GL.GL_TEXTURE_2D, name, value)
            GL.glSamplerParameteri(self._nearest, name, value)
        for name in (GL.GL_TEXTURE_MIN_FILTER, GL.GL_TEXTURE_MAG_FILTER):
            GL.glTexParameteri(GL.GL_TEXTURE_2D, name, GL.GL_LINEAR)
            GL.glSamplerParameteri(self._nearest, name, GL.GL_NEAREST)
        self._framebuffer = int(GL.glGenFramebuffers(1))
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self._framebuffer)
        GL.glFramebufferTexture2D(
            GL.GL_FRAMEBUFFER, GL.GL_DEPTH_ATTACHMENT, GL.GL_TEXTURE_2D, self._texture, 0)
        GL.glDrawBuffer(GL.GL_NONE)
        GL.glReadBuffer(GL.GL_NONE)
        status = GL.glCheckFramebufferStatus(GL.GL_FRAMEBUFFER)
        if status != GL.GL_FRAMEBUFFER_COMPLETE:
            raise DeviceError(
                f'the device cannot draw into a depth texture of {side} x {side} pixels '
                f'({status:#x}): use another device')

    def begin(self) -> None:
        """Direct drawing here, with nothing drawn yet."""
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self._framebuffer)
        GL.glViewport(0, 0, self.side, self.side)
        GL.glDepthMask(GL.GL_TRUE)
        GL.glClear(GL.GL_DEPTH_BUFFER_BIT)

    def bind(self, unit: int) -> None:
        """Let shaders compare with it, as the sampler2DShadow of ``unit``."""
        GL.glActiveTexture(GL.GL_TEXTURE0 + unit)
        GL.glBindTexture(GL.GL_TEXTURE_2D, self._texture)

    def bind_nearest(self, unit: int) -> None:
        """Let shaders compare with the nearest pixel alone, in another unit than ``bind``."""
        self.bind(unit)
        GL.glBindSampler(unit, self._nearest)

    def delete(self) -> None:
        """Free the memory."""
        GL.glDeleteFramebuffers(1, [self._framebuffer])
        GL.glDeleteTextures(1, [self._texture])
        GL.glDeleteSamplers(1, [self._nearest])


# State that decides whether a drawn pixel is visible: depth test, blending and face culling.


def blend_by_opacity() -> None:
    """Blend colours over the image by their alpha."""
    GL.glEnable(GL.GL_BLEND)
    GL.glBlendFunc(GL.GL_SRC_ALPHA, GL.GL_ONE_MINUS_SRC_ALPHA)


def draw_over_all() -> None:
    """Draw over the image without depth test, and do not write depths."""
    GL.glDisable(GL.GL_DEPTH_TEST)


def draw_nearest(*, hides: bool = True) -> None:
    """
    Draw pixels that are not hidden.

    :param hides: whether to write depths, so that later and farther pixels are hidden
    """
    GL.glEnable(GL.GL_DEPTH_TEST)
    GL.glDepthFunc(GL.GL_LEQUAL)
    GL.glDepthMask(hides)


def draw_hidden() -> None:
    """Draw only pixels that other parts hide."""
    GL.glEnable(GL.GL_DEPTH_TEST)
    GL.glDepthFunc(GL.GL_GREATER)
    GL.glDepthMask(False)


def clamp_depths(is_on: bool) -> None:
    """Draw what is nearer or farther than the depth buffer tells apart, at its ends."""
    if is_on:
        GL.glEnable(GL.GL_DEPTH_CLAMP)
    else:
        GL.glDisable(GL.GL_DEPTH_CLAMP)


@contextmanager
def draw_within(left: int, bottom: int, width: int, height: int) -> Iterator[None]:
    """Draw nothing outside of a part of the image [pixel]."""
    GL.glEnable(GL.GL_SCISSOR_TEST)
    GL.glScissor(left, bottom, width, height)
    try:
        yield
    finally:
        GL.glDisable(GL.GL_SCISSOR_TEST)


def draw_clockwise_only(is_on: bool) -> None:
    """Cull triangles that are counter-clockwise in the image, or stop culling."""
    if is_on:
        GL.glEnable(GL.GL_CULL_FACE)
        GL.glCullFace(GL.GL_FRONT)
    else:
        GL.glDisable(GL.GL_CULL_FACE)
