# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A GL 4.3 context without a window, on the best device there is, and how one is lost."""

import os
import subprocess
import sys

from cloth_sim_ros.gl import context as gl_context
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from OpenGL import GL
from OpenGL.error import GLError
import pytest

# A device that is reset is noticed.
#
# No software device can be reset, so the status that the driver would give is stood in for.

SCENE = Scene({'rows': 4, 'cols': 4})


def lose(monkeypatch, status=GL.GL_GUILTY_CONTEXT_RESET):
    """Have the driver say that the context is lost."""
    monkeypatch.setattr(gl_context, 'reset_status', lambda: status)


def test_the_driver_is_asked():
    """A reset would never be noticed: the answer has to come from the driver."""
    Context(single_thread=True)
    assert gl_context._status_call() is not None
    assert gl_context.reset_status() == GL.GL_NO_ERROR


@pytest.mark.parametrize('status, reason', [
    (GL.GL_GUILTY_CONTEXT_RESET, 'because of this process'),
    (GL.GL_INNOCENT_CONTEXT_RESET, 'because of another process'),
    (GL.GL_UNKNOWN_CONTEXT_RESET, 'for an unknown reason'), (0x1234, '(0x1234)')])
def test_a_reset_ends_a_step_with_the_reason(status, reason, monkeypatch):
    """The cloth would stand still, or be full of zeros, and nobody would know why."""
    simulation = Simulation(SCENE)
    simulation.step(3)
    lose(monkeypatch, status)
    with pytest.raises(DeviceError) as caught:
        simulation.step()
    assert str(caught.value).startswith(
        f'the GL device was reset {reason}, and its contents are lost')
    assert 'restart' in str(caught.value)


@pytest.mark.parametrize('ask', [
    lambda simulation: simulation.snapshot(), lambda simulation: simulation.measure(),
    lambda simulation: simulation.positions(), lambda simulation: simulation.reset(),
    lambda simulation: simulation.pin(3, 3)],
    ids=['snapshot', 'measure', 'positions', 'reset', 'pin'])
def test_no_answer_comes_from_a_lost_device(ask, monkeypatch):
    """A reader would take what is left in memory for the cloth."""
    simulation = Simulation(SCENE)
    simulation.step(3)
    lose(monkeypatch)
    with pytest.raises(DeviceError, match='the GL device was reset'):
        ask(simulation)


def test_what_gl_says_of_a_lost_context_is_told_as_such(monkeypatch):
    """The error that GL gives then is a number in a traceback."""
    lose(monkeypatch)
    with pytest.raises(DeviceError, match='the GL device was reset'), gl_context.loss_noticed():
        raise GLError(0x0507)


def test_other_errors_stay_as_they_are():
    """A fault of the program would be reported as a reset."""
    Context(single_thread=True)
    with pytest.raises(GLError), gl_context.loss_noticed():
        raise GLError(GL.GL_INVALID_VALUE)


# The context is a compute context on a named device, or says what is missing.

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
