# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the device is, and the limits that the shaders rely on."""

from collections.abc import Iterator
import subprocess

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.device import headless_displays
from cloth_sim_ros.gl.libraries import GL
from gpu.section import FAULT
from gpu.section import Row
from gpu.section import Section
import numpy as np
import OpenGL

# Least value of each limit that the shaders need; 32 KiB of shared memory is what GL 4.3 grants.
_NEEDED = {
    'GL_MAX_COMPUTE_SHARED_MEMORY_SIZE': 32 * 1024,
    'GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS': 1024,
    'GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS': 8,
    'GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS': 8,
    'GL_MAX_COMPUTE_UNIFORM_COMPONENTS': 1024,
    'GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS': 8,
    'GL_MAX_TEXTURE_BUFFER_SIZE': 65536,
    'GL_MAX_SHADER_STORAGE_BLOCK_SIZE': 2**27,
}


def board() -> dict[str, str]:
    """Return power draw and memory in use by nvidia-smi; nothing without it."""
    fields = ('power.draw', 'memory.used', 'clocks.sm', 'temperature.gpu')
    try:
        done = subprocess.run(
            ['nvidia-smi', f'--query-gpu={",".join(fields)}', '--format=csv,noheader'],
            capture_output=True, text=True, check=True, timeout=10)
    except (OSError, subprocess.SubprocessError):
        return {}
    return dict(zip(fields, (text.strip() for text in done.stdout.splitlines()[0].split(','))))


def _measure(quick: bool) -> Iterator[Row]:
    displays = len(list(headless_displays()))
    context = Context()
    yield {
        'device': context.device, 'driver': context.version,
        'EGL displays': displays, 'NumPy': np.__version__, 'PyOpenGL': OpenGL.__version__,
        **board()}
    for name, least in _NEEDED.items():
        found = int(GL.glGetIntegerv(getattr(GL, name)))
        yield {'limit': name, 'value': found, 'needed': least,
               FAULT: '' if found >= least else 'below what the shaders need'}
    context.close()


SECTION = Section('device', 'Device and limits', 20.0, _measure)
