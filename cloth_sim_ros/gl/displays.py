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
