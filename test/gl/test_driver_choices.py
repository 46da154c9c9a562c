# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Whatever is chosen of the driver: it runs right, or one line says what is lacking."""

from cloth_sim_ros.gl.context import Context
from command import cloth_sim
import numpy as np
import pytest

SCENE = '/**: {ros__parameters: {rows: 9, cols: 12, mode: %s}}'
WITHOUT_TEXTURES = {
    'MESA_EXTENSION_OVERRIDE': '-GL_ARB_texture_buffer_object', 'MESA_GL_VERSION_OVERRIDE': '4.5'}
# Mesa cannot leave these calls of GL 4.4 out, other drivers can.
WITHOUT_MULTI_BIND = (
    'from cloth_sim_ros.gl import quick_calls; quick_calls.multi_bind = lambda: None')


@pytest.fixture(scope='module', autouse=True)
def mesa():
    """Leave the tests out where no Mesa reads these choices: another driver runs as ever."""
    context = Context()
    version = context.version
    context.close()
    if 'Mesa' not in version:
        pytest.skip(f'these are choices that Mesa offers, and the device has {version}')


@pytest.fixture(scope='module')
def usual(tmp_path_factory):
    """Return the positions that a run comes to without such a choice."""
    return run(tmp_path_factory.mktemp('usual'), {})[1]


def run(tmp_path, environment, mode='mass_spring', *options, before=''):
    """Return how `cloth_sim run` ended, and the positions it came to, if any."""
    scene, state = tmp_path / 'scene.yaml', tmp_path / 'state.npz'
    scene.write_text(SCENE % mode)
    state.unlink(missing_ok=True)
    result = cloth_sim(
        'run', str(scene), '--seconds', '0.05', '--out', str(state), *options,
        before='\n'.join([
            'import os', f'os.environ.update({environment})', before]))
    if not state.exists():
        return result, None
    with np.load(state) as arrays:
        return result, arrays['positions']


@pytest.mark.parametrize('environment', [
    {'MESA_NO_ERROR': '1'}, {'PYOPENGL_PLATFORM': 'bad'}, {'EGL_PLATFORM': 'bad'},
    {'MESA_EXTENSION_OVERRIDE': '-GL_KHR_robustness'}, WITHOUT_TEXTURES,
    *(pytest.param(environment, marks=pytest.mark.long) for environment in (
        {'PYOPENGL_PLATFORM': 'osmesa'}, {'PYOPENGL_PLATFORM': 'glx'},
        {'LIBGL_ALWAYS_SOFTWARE': '1'}, {'MESA_LOADER_DRIVER_OVERRIDE': 'bad'},
        {'MESA_GL_VERSION_OVERRIDE': '4.3'}, {**WITHOUT_TEXTURES, 'MESA_NO_ERROR': '1'}))],
    ids=lambda environment: ' '.join(f'{name}={value}' for name, value in environment.items()))
def test_what_can_run_runs_the_same(environment, tmp_path, usual):
    """A user would get a traceback, or another cloth, for a variable that changes nothing here."""
    result, positions = run(tmp_path, environment)
    assert result.returncode == 0, result.stderr
    np.testing.assert_array_equal(positions, usual)


def test_a_driver_without_multi_bind_runs_the_same(tmp_path, usual):
    """A driver that has OpenGL 4.3 and no more would fail in the first step."""
    result, positions = run(tmp_path, {}, before=WITHOUT_MULTI_BIND)
    assert result.returncode == 0, result.stderr
    np.testing.assert_array_equal(positions, usual)


@pytest.mark.parametrize('mode', ['constraint', 'adaptive'])
def test_all_modes_run_without_texture_buffers(mode, tmp_path):
    """A device without them could step a cloth in one mode, and crash at the switch to another."""
    _, expected = run(tmp_path, {}, mode, '--set', 'loads=storage')
    result, positions = run(tmp_path, WITHOUT_TEXTURES, mode)
    assert result.returncode == 0, result.stderr
    np.testing.assert_array_equal(positions, expected)


@pytest.mark.parametrize('environment, reasons', [
    ({'GALLIUM_DRIVER': 'softpipe'}, ('softpipe has OpenGL 3.3', 'unset GALLIUM_DRIVER')),
    ({'GALLIUM_DRIVER': 'bad'}, ('or unset GALLIUM_DRIVER',)),
    ({'MESA_GL_VERSION_OVERRIDE': '3.3'}, (
        'has OpenGL 3.3', 'unset MESA_GL_VERSION_OVERRIDE')),
    ({'MESA_GLSL_VERSION_OVERRIDE': '330'}, ('unset MESA_GLSL_VERSION_OVERRIDE',)),
    *(({'MESA_EXTENSION_OVERRIDE': f'-{part}'}, (
        f'lacks {part}', 'llvmpipe', 'unset MESA_EXTENSION_OVERRIDE')) for part in (
        'GL_ARB_texture_buffer_object', 'GL_ARB_compute_shader', 'GL_ARB_texture_buffer_range',
        'GL_ARB_shader_storage_buffer_object', 'GL_ARB_shader_image_load_store')),
    ({'__EGL_VENDOR_LIBRARY_DIRS': '/nonexistent'}, (
        'install the GPU driver', 'or unset __EGL_VENDOR_LIBRARY_DIRS'))], ids=str)
def test_what_cannot_run_says_what_is_lacking(environment, reasons, tmp_path):
    """A user with Mesa would be advised to install Mesa, or get a traceback or a crash."""
    result, positions = run(tmp_path, environment)
    assert positions is None
    assert result.returncode == 1, (result.returncode, result.stderr)
    assert len(result.stderr.splitlines()) == 1, result.stderr
    assert 'there is no EGL device with OpenGL 4.3' in result.stderr
    assert all(reason in result.stderr for reason in reasons), result.stderr


def test_texture_loads_are_refused_where_there_are_none(tmp_path):
    """The device would be asked for what it does not have, and crash."""
    result, positions = run(tmp_path, WITHOUT_TEXTURES, 'mass_spring', '--set', 'loads=texture')
    assert positions is None and result.returncode == 1
    assert len(result.stderr.splitlines()) == 1
    assert 'lacks: set loads: storage, or auto' in result.stderr


@pytest.mark.parametrize('before, reason', [
    ('import ctypes\n'
     'load = ctypes.CDLL.__init__\n'
     'def init(self, name, *rest, **more):\n'
     '    if "EGL" in str(name): raise OSError(f"{name}: cannot open shared object file")\n'
     '    load(self, name, *rest, **more)\n'
     'ctypes.CDLL.__init__ = init', 'the EGL library cannot be loaded: install the GPU driver'),
    ('import sys; sys.modules["OpenGL"] = None', 'pip install PyOpenGL'),
    ('import os; os.environ["PYOPENGL_PLATFORM"] = "glx"\nimport OpenGL.platform', (
        'OpenGL was imported for the platform OpenGL.platform.glx already'))],
    ids=['no EGL', 'no PyOpenGL', 'another platform before'])
def test_missing_libraries_are_told(before, reason, tmp_path):
    """A machine without them would give a traceback of an import."""
    result, positions = run(tmp_path, {}, before=before)
    assert positions is None and result.returncode == 1
    assert len(result.stderr.splitlines()) == 1, result.stderr
    assert reason in result.stderr
