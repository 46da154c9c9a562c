# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The GL devices of this machine: what each is and has, and why none of them will do."""

from collections.abc import Iterable
from collections.abc import Iterator
from collections.abc import Mapping
from dataclasses import dataclass
import os
import re

from cloth_sim_ros.gl.libraries import EGL
from cloth_sim_ros.gl.libraries import error
from cloth_sim_ros.gl.libraries import GL
from cloth_sim_ros.gl.libraries import INSTALL
from OpenGL.EGL.EXT.device_base import EGLDeviceEXT
from OpenGL.EGL.EXT.device_base import eglQueryDevicesEXT
from OpenGL.EGL.EXT.platform_base import eglGetPlatformDisplayEXT
from OpenGL.EGL.EXT.platform_device import EGL_PLATFORM_DEVICE_EXT

EGL_PLATFORM_SURFACELESS_MESA = 0x31DD
_MOST_DEVICES = 16


def headless_displays() -> Iterator[EGL.EGLDisplay]:
    """Yield initialised displays: those of devices, then Mesa's surfaceless one."""
    for platform, native in (*_device_platforms(), (EGL_PLATFORM_SURFACELESS_MESA, None)):
        try:
            display = eglGetPlatformDisplayEXT(platform, native, None)
            major, minor = EGL.EGLint(), EGL.EGLint()
            if display and EGL.eglInitialize(display, major, minor):
                yield display
        except (error.Error, error.NullFunctionError):
            continue


def _device_platforms() -> list[tuple[int, EGLDeviceEXT]]:
    devices = (EGLDeviceEXT * _MOST_DEVICES)()
    count = EGL.EGLint()
    try:
        if not eglQueryDevicesEXT(_MOST_DEVICES, devices, count):
            return []
    except (error.Error, error.NullFunctionError):
        return []
    return [(EGL_PLATFORM_DEVICE_EXT, devices[i]) for i in range(count.value)]


# Properties of a GL device, and the reasons why a machine has no suitable one.

VERSION = (4, 3)
TEXTURE_BUFFERS = 'GL_ARB_texture_buffer_object'
# Parts of OpenGL 4.3 that drivers of an earlier version may lack, those the shaders use first.
_PARTS = (
    'GL_ARB_compute_shader', 'GL_ARB_shader_storage_buffer_object',
    'GL_ARB_shader_image_load_store', TEXTURE_BUFFERS, 'GL_ARB_draw_indirect',
    'GL_ARB_gpu_shader5', 'GL_ARB_gpu_shader_fp64', 'GL_ARB_shading_language_420pack',
    'GL_ARB_texture_buffer_object_rgb32', 'GL_ARB_texture_buffer_range', 'GL_ARB_texture_view',
    'GL_ARB_shader_image_size', 'GL_ARB_vertex_attrib_binding')
_MOST_NAMED = 4
# Environment variables that choose the device or version, and can be the reason.
_CHOICES = (
    'GALLIUM_DRIVER', 'LIBGL_ALWAYS_SOFTWARE', 'LIBGL_DRIVERS_PATH', 'MESA_LOADER_DRIVER_OVERRIDE',
    'MESA_GL_VERSION_OVERRIDE', 'MESA_GLSL_VERSION_OVERRIDE', 'MESA_EXTENSION_OVERRIDE',
    '__EGL_VENDOR_LIBRARY_DIRS', '__EGL_VENDOR_LIBRARY_FILENAMES', 'EGL_PLATFORM')


@dataclass(frozen=True)
class DeviceReport:
    """
    What a context reports about its device.

    :param version: of OpenGL, as the driver writes it
    :param language: version of the shading language
    """

    renderer: str
    version: str
    language: str
    extensions: frozenset[str]

    @classmethod
    def of_current_context(cls) -> 'DeviceReport':
        """Ask the context that is current."""
        renderer, version, language = (
            (GL.glGetString(name) or b'unknown').decode(errors='replace')
            for name in (GL.GL_RENDERER, GL.GL_VERSION, GL.GL_SHADING_LANGUAGE_VERSION))
        return cls(renderer, version, language, frozenset(extensions_of_current_context()))

    @property
    def has_core_profile(self) -> bool:
        """
        Return whether to ask the driver for a core profile.

        Mesa crashes when it has none, which is where it comes to no more than OpenGL 3.0 for lack
        of texture buffers.
        """
        return self._numbers >= (3, 1) or TEXTURE_BUFFERS in self.extensions

    def __str__(self) -> str:
        """Return device, version and what is lacking, in words."""
        lacking = [part for part in _PARTS if part not in self.extensions][:_MOST_NAMED]
        without = f' and lacks {", ".join(lacking)}' if lacking else ''
        if self._numbers >= VERSION:
            without = ', but no core profile of it'
        return f'{self.renderer} has OpenGL {self.version}, GLSL {self.language}{without}'

    @property
    def _numbers(self) -> tuple[int, ...]:
        found = re.match(r'(\d+)\.(\d+)', self.version)
        return tuple(map(int, found.groups())) if found else (0, 0)


def extensions_of_current_context() -> list[str]:
    """Return the names of all extensions of the context that is current."""
    count = int(GL.glGetIntegerv(GL.GL_NUM_EXTENSIONS))
    return [GL.glGetStringi(GL.GL_EXTENSIONS, number).decode() for number in range(count)]


def refusal(
        reports: Iterable[DeviceReport], environment: Mapping[str, str] = os.environ) -> str:
    """Return why there is no context, what there is in its place, and the way out."""
    wanted = '.'.join(map(str, VERSION))
    found = '; '.join(dict.fromkeys(map(str, reports)))
    chosen = ' and '.join(name for name in _CHOICES if name in environment)
    if found:
        return f'there is no EGL device with OpenGL {wanted}, as {found}: ' + (
            f'unset {chosen}, or install a newer driver' if chosen else f'update it, or {INSTALL}')
    return f'there is no EGL device with OpenGL {wanted}: {INSTALL}' + (
        f', or unset {chosen}' if chosen else '')
