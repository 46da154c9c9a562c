# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""A GL 4.3 context without a window, on the best device there is."""

from collections.abc import Iterator
from contextlib import contextmanager
import os

from cloth_sim_ros.gl.displays import headless_displays
from cloth_sim_ros.gl.errors import DeviceError
from OpenGL import EGL
from OpenGL import error
from OpenGL import GL

_SOFTWARE = ('llvmpipe', 'softpipe', 'swrast', 'swr')
_VERSION = (4, 3)
_CONTEXT_ATTRIBUTES = (
    EGL.EGL_CONTEXT_MAJOR_VERSION, _VERSION[0],
    EGL.EGL_CONTEXT_MINOR_VERSION, _VERSION[1],
    EGL.EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL.EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
    EGL.EGL_NONE)


class Context:
    """
    An OpenGL context that belongs to the thread it was made on.

    A GPU is taken before a software device.

    :param single_thread: run a software device without worker threads, which is faster for
        small work; LP_NUM_THREADS in the environment wins
    :param beside: a context whose device, buffers and programs the new one has as well. Made on
        another thread, it compiles there while the first goes on; ``release`` it there before it
        is used on this one. Some drivers compile for each context anew, when a program first runs.
    :raises DeviceError: when there is no EGL device with OpenGL 4.3
    """

    def __init__(
            self, *, single_thread: bool = False, beside: 'Context | None' = None) -> None:
        """Make the context and make it current."""
        if beside is None:
            with _worker_threads(single_thread):
                self._display, self._context = _best_context()
        else:
            self._display = beside._display
            self._context = _make_context(beside._display, beside._context)
            if self._context is None:
                raise DeviceError(f'{beside.device} has no second GL context: set the mode before '
                                  'the run begins')
        self.make_current()
        self.device = GL.glGetString(GL.GL_RENDERER).decode()
        self.version = GL.glGetString(GL.GL_VERSION).decode()
        self.is_software = is_software(self.device)
        self.max_buffer_bytes = _integer(GL.GL_MAX_SHADER_STORAGE_BLOCK_SIZE)
        self.max_texture_texels = _integer(GL.GL_MAX_TEXTURE_BUFFER_SIZE)

    def make_current(self) -> None:
        """Direct the GL calls of this thread to this context."""
        if not EGL.eglMakeCurrent(
                self._display, EGL.EGL_NO_SURFACE, EGL.EGL_NO_SURFACE, self._context):
            raise DeviceError('the GL context cannot be used on this thread: use it where it '
                              'was made')

    def release(self) -> None:
        """Have no context on this thread, so that this one can be used on another."""
        GL.glFinish()
        EGL.eglMakeCurrent(
            self._display, EGL.EGL_NO_SURFACE, EGL.EGL_NO_SURFACE, EGL.EGL_NO_CONTEXT)

    def finish(self) -> None:
        """Wait until the device has done everything asked of it."""
        self.make_current()
        GL.glFinish()

    def close(self) -> None:
        """Give the context and all its buffers back."""
        if self._context is not None:
            EGL.eglMakeCurrent(
                self._display, EGL.EGL_NO_SURFACE, EGL.EGL_NO_SURFACE, EGL.EGL_NO_CONTEXT)
            EGL.eglDestroyContext(self._display, self._context)
            self._context = None


def _best_context() -> tuple[EGL.EGLDisplay, EGL.EGLContext]:
    software = None
    for display in headless_displays():
        context = _make_context(display)
        if context is None:
            continue
        EGL.eglMakeCurrent(display, EGL.EGL_NO_SURFACE, EGL.EGL_NO_SURFACE, context)
        if not is_software(GL.glGetString(GL.GL_RENDERER).decode()):
            return display, context
        software = software or (display, context)
        if software[1] is not context:
            EGL.eglDestroyContext(display, context)
    if software is None:
        raise DeviceError(
            'there is no EGL device with OpenGL 4.3: install the GPU driver with its EGL '
            'library, or Mesa (Debian and Ubuntu: apt install libegl1 libgl1-mesa-dri)')
    return software


def _make_context(
        display: EGL.EGLDisplay,
        shared: EGL.EGLContext = EGL.EGL_NO_CONTEXT) -> EGL.EGLContext | None:
    try:
        if not EGL.eglBindAPI(EGL.EGL_OPENGL_API):
            return None
        configs = (EGL.EGLConfig * 1)()
        count = EGL.EGLint()
        wanted = (EGL.EGL_RENDERABLE_TYPE, EGL.EGL_OPENGL_BIT,
                  EGL.EGL_SURFACE_TYPE, EGL.EGL_PBUFFER_BIT, EGL.EGL_NONE)
        EGL.eglChooseConfig(display, wanted, configs, 1, count)
        if not count.value:
            return None
        context = EGL.eglCreateContext(
            display, configs[0], shared, _CONTEXT_ATTRIBUTES)
    except error.Error:
        return None
    return context or None


def is_software(renderer: str) -> bool:
    return any(name in renderer.lower() for name in _SOFTWARE)


def _integer(name: int) -> int:
    return int(GL.glGetIntegerv(name))


@contextmanager
def _worker_threads(single_thread: bool) -> Iterator[None]:
    # llvmpipe reads this once, when its first context is made.
    name = 'LP_NUM_THREADS'
    if not single_thread or name in os.environ:
        yield
        return
    os.environ[name] = '0'
    try:
        yield
    finally:
        del os.environ[name]
