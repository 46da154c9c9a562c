# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A GL 4.3 context without a window, on the best device there is, and how one is lost."""

from collections.abc import Callable
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import c_void_p
from ctypes import cast
from functools import cache
import os

from cloth_sim_ros.gl import quick_calls
from cloth_sim_ros.gl.device import DeviceReport
from cloth_sim_ros.gl.device import extensions_of_current_context
from cloth_sim_ros.gl.device import headless_displays
from cloth_sim_ros.gl.device import refusal
from cloth_sim_ros.gl.device import VERSION
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.forked import forks
from cloth_sim_ros.gl.forked import note_device
from cloth_sim_ros.gl.forked import refuse_context_of
from cloth_sim_ros.gl.forked import refuse_new_context
from cloth_sim_ros.gl.libraries import EGL
from cloth_sim_ros.gl.libraries import error
from cloth_sim_ros.gl.libraries import GL
from cloth_sim_ros.gl.libraries import GLQuerier
from cloth_sim_ros.gl.libraries import PLATFORM
from cloth_sim_ros.gl.libraries import VERSION_EXTENSIONS
from cloth_sim_ros.gl.program_pool import ProgramPool
from cloth_sim_ros.gl.program_pool import set_current_pool
from OpenGL.GL.ARB.robustness import glGetGraphicsResetStatusARB

# A GL context that was lost: the GPU was reset, or its driver removed.
#
# Afterwards GL calls have no effect, and data read from the device are undefined.

_REASONS = {
    GL.GL_GUILTY_CONTEXT_RESET: 'because of this process',
    GL.GL_INNOCENT_CONTEXT_RESET: 'because of another process',
    GL.GL_UNKNOWN_CONTEXT_RESET: 'for an unknown reason',
}


def reset_status() -> int:
    """Return why the context that is current was lost; GL_NO_ERROR when it was not."""
    ask = _status_call()
    return GL.GL_NO_ERROR if ask is None else ask()


def refuse_lost_context() -> None:
    """Raise DeviceError when the context that is current was lost."""
    status = reset_status()
    if status != GL.GL_NO_ERROR:
        raise DeviceError(
            f'the GL device was reset {_REASONS.get(status, f"({status:#x})")}, and its contents '
            'are lost: restart and, if it happens again, use a smaller cloth or another device')


@contextmanager
def loss_noticed() -> Iterator[None]:
    """Raise DeviceError instead of the GL errors of a lost context."""
    try:
        yield
    except error.GLError:
        refuse_lost_context()
        raise
    refuse_lost_context()


@cache
def _status_call() -> Callable[[], int] | None:
    """Return the call of the driver, without PyOpenGL's look for errors; None without one."""
    for call in (GL.glGetGraphicsResetStatus, glGetGraphicsResetStatusARB):
        if call:
            return PLATFORM.constructFunction(
                call.__name__, PLATFORM.GL, int, (), extension=None, force_extension=True)
    return None


# A GL 4.3 context without a window, on the best device there is.

_SOFTWARE = ('llvmpipe', 'softpipe', 'swrast', 'swr')
_CORE = (
    EGL.EGL_CONTEXT_MAJOR_VERSION, VERSION[0],
    EGL.EGL_CONTEXT_MINOR_VERSION, VERSION[1],
    EGL.EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL.EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT)
# With these attributes the driver reports a reset, which context_loss detects.
_REPORTS_RESETS = (
    *_CORE, EGL.EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL.EGL_LOSE_CONTEXT_ON_RESET)
_ANY: tuple[int, ...] = ()


class Context:
    """
    An OpenGL context that belongs to the thread it was made on.

    A GPU is taken before a software device.

    :param single_thread: run a software device without worker threads, which is faster for
        small work; LP_NUM_THREADS in the environment wins
    :param beside: a context whose device, buffers and programs the new one has as well. Made on
        another thread, it compiles there while the first goes on; ``release`` it there before it
        is used on this one. Some drivers compile for each context anew, when a program first runs.
    :raises DeviceError: when there is no EGL device with OpenGL 4.3, with what there is
    """

    device: str

    def __init__(
            self, *, single_thread: bool = False, beside: 'Context | None' = None) -> None:
        """Make the context and make it current."""
        refuse_new_context()
        self._forks = forks()
        if beside is None:
            with _worker_threads(single_thread):
                self._display, self._context, self._attributes = _best_context()
            self._programs = ProgramPool()
        else:
            self._display, self._attributes = beside._display, beside._attributes
            self._programs = beside._programs
            self._context = _make_context(self._display, self._attributes, beside._context)
            if self._context is None:
                raise DeviceError(f'{beside.device} has no second GL context: set the mode before '
                                  'the run begins')
        self._addresses = (_address(self._display), 0, 0, _address(self._context))
        self.make_current()
        _set_extensions()
        self.device = GL.glGetString(GL.GL_RENDERER).decode()
        self.version = GL.glGetString(GL.GL_VERSION).decode()
        self.is_software = is_software(self.device)
        note_device(self.is_software)
        self.max_buffer_bytes = _integer(GL.GL_MAX_SHADER_STORAGE_BLOCK_SIZE)
        # 0 without texture buffers.
        self.max_texture_texels = _integer(GL.GL_MAX_TEXTURE_BUFFER_SIZE)

    def make_current(self) -> None:
        """Direct the GL calls of this thread to this context; DeviceError once it is closed."""
        refuse_context_of(self._forks)
        if self._context is None:
            raise DeviceError('the GL context is closed: create a new Simulation')
        if not quick_calls.make_current(*self._addresses):
            raise DeviceError('the GL context cannot be used on this thread: use it on the thread '
                              'that created it')
        set_current_pool(self._programs)

    @property
    def is_of_parent(self) -> bool:
        """Return whether this process was forked since the context was made."""
        return self._forks != forks()

    def release(self) -> None:
        """Have no context on this thread, so that this one can be used on another."""
        GL.glFinish()
        EGL.eglMakeCurrent(
            self._display, EGL.EGL_NO_SURFACE, EGL.EGL_NO_SURFACE, EGL.EGL_NO_CONTEXT)
        set_current_pool(None)

    def finish(self) -> None:
        """Wait until the device has done everything asked of it."""
        self.make_current()
        GL.glFinish()

    def close(self) -> None:
        """Release the context and all its buffers; in a forked child they are the parent's."""
        if self.is_of_parent:
            self._context = None
        if self._context is not None:
            EGL.eglMakeCurrent(
                self._display, EGL.EGL_NO_SURFACE, EGL.EGL_NO_SURFACE, EGL.EGL_NO_CONTEXT)
            EGL.eglDestroyContext(self._display, self._context)
            self._context = None
            set_current_pool(None)


def _address(pointer: EGL.EGLDisplay | EGL.EGLContext) -> int:
    return cast(pointer, c_void_p).value or 0


def _best_context() -> tuple[EGL.EGLDisplay, EGL.EGLContext, tuple[int, ...]]:
    software = None
    reports = []
    for display in headless_displays():
        report = _report(display)
        if report is None:
            continue
        made = _make_core_context(display) if report.has_core_profile else None
        if made is None:
            reports.append(report)
            continue
        if not is_software(report.renderer):
            return made
        if software is None:
            software = made
        else:
            EGL.eglDestroyContext(display, made[1])
    if software is None:
        raise DeviceError(refusal(reports))
    return software


def _report(display: EGL.EGLDisplay) -> DeviceReport | None:
    """Return what ``display`` has, whatever its version; None when it makes no context at all."""
    context = _make_context(display, _ANY)
    if context is None:
        return None
    try:
        EGL.eglMakeCurrent(display, EGL.EGL_NO_SURFACE, EGL.EGL_NO_SURFACE, context)
        return DeviceReport.of_current_context()
    finally:
        EGL.eglMakeCurrent(
            display, EGL.EGL_NO_SURFACE, EGL.EGL_NO_SURFACE, EGL.EGL_NO_CONTEXT)
        EGL.eglDestroyContext(display, context)


def _make_core_context(
        display: EGL.EGLDisplay) -> tuple[EGL.EGLDisplay, EGL.EGLContext, tuple[int, ...]] | None:
    for attributes in (_REPORTS_RESETS, _CORE):
        context = _make_context(display, attributes)
        if context is not None:
            return display, context, attributes
    return None


def _make_context(
        display: EGL.EGLDisplay, attributes: tuple[int, ...],
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
            display, configs[0], shared, (*attributes, EGL.EGL_NONE))
    except error.Error:
        return None
    return context or None


def _set_extensions() -> None:
    """
    Set the extensions of the current context in PyOpenGL if it has found none.

    PyOpenGL uses the query of a core profile only after an error of the older query, which a
    context without errors (MESA_NO_ERROR) does not raise.
    """
    if not GLQuerier.getExtensions():
        implied = [
            name for version, names in VERSION_EXTENSIONS if version <= VERSION for name in names]
        GLQuerier.extensions = [
            name.encode() for name in extensions_of_current_context()] + implied


def is_software(renderer: str) -> bool:
    return any(name in renderer.lower() for name in _SOFTWARE)


def _integer(name: int) -> int:
    try:
        return int(GL.glGetIntegerv(name))
    except error.GLError:
        return 0


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
