# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
OpenGL and EGL as PyOpenGL has them, or the reason why they cannot be used.

Importing this raises DeviceError where they are missing. All of this folder has them from here.
"""

from cloth_sim_ros.gl.errors import DeviceError

INSTALL = (
    'install the GPU driver with its EGL library, or Mesa (Debian and Ubuntu: apt install '
    'libegl1 libgl1-mesa-dri)')

try:
    from OpenGL import EGL  # noqa: F401
    from OpenGL import error  # noqa: F401
    from OpenGL import GL  # noqa: F401
    from OpenGL.extensions import GLQuerier  # noqa: F401
    from OpenGL.extensions import VERSION_EXTENSIONS  # noqa: F401
    from OpenGL.platform import PLATFORM
    from OpenGL.platform.egl import EGLPlatform
except ModuleNotFoundError as missing:
    raise DeviceError(
        f'the Python module {missing.name} is missing: install python3-opengl, or run `pip '
        'install PyOpenGL`') from missing
except (ImportError, AttributeError, TypeError) as problem:
    # Where PyOpenGL finds no library, it goes on without and trips over it.
    raise DeviceError(f'the EGL library cannot be loaded: {INSTALL}') from problem

if not isinstance(PLATFORM, EGLPlatform):
    raise DeviceError(
        f'OpenGL was imported for the platform {type(PLATFORM).__module__} already, but a context '
        'without a window needs EGL: import cloth_sim_ros first, or set PYOPENGL_PLATFORM=egl')
