# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The context is a compute context on a named device, or says what is missing."""

import os
import subprocess
import sys

from cloth_sim_ros.gl.context import Context

_MAKE_CONTEXT = 'from cloth_sim_ros.gl.context import Context; print(Context().device)'


def run_python(code: str, **environment: str) -> subprocess.CompletedProcess:
    """Run ``code`` in a process of its own, where EGL starts anew."""
    return subprocess.run(
        [sys.executable, '-c', code], env={**os.environ, **environment},
        capture_output=True, text=True)


def test_the_device_has_a_name_and_limits():
    """A user could not tell which device runs, or a large cloth would overrun its buffers."""
    context = Context()
    assert context.device
    assert context.max_buffer_bytes >= 2**24
    assert context.max_texture_texels >= 2**16


def test_no_egl_device_is_said_with_the_way_out():
    """On a machine without drivers the user would get a bare EGL error code."""
    done = run_python(_MAKE_CONTEXT, __EGL_VENDOR_LIBRARY_DIRS='/nonexistent')
    assert done.returncode != 0
    assert 'there is no EGL device with OpenGL 4.3: install' in done.stderr


def test_worker_threads_are_left_as_they_were():
    """A choice made for a small cloth would leak into the processes started from here."""
    before = os.environ.get('LP_NUM_THREADS')
    Context(single_thread=True).close()
    assert os.environ.get('LP_NUM_THREADS') == before
