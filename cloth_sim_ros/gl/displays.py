# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The EGL displays of this machine that need no window, best first."""

from collections.abc import Iterator

from cloth_sim_ros.gl.libraries import EGL
from cloth_sim_ros.gl.libraries import error
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
