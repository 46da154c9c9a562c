# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The set-up has the driver compile the shaders, so that the first run need not wait for that."""

from pathlib import Path
import sys

import pytest
from setup_parts import run_bash

ROOT = Path(__file__).resolve().parents[3]
COMPILING = 'Compiling the shaders (once per machine)'


# The driver need not optimise what nobody runs.
QUICK_DRIVER = 'export GALLIVM_PERF=nopt'


def compile_shaders(folder: Path, environment: str) -> str:
    """Run that part of the set-up with its stamps in ``folder``; return what it said."""
    stamps = folder / 'stamps'
    stamps.mkdir(exist_ok=True)
    code, output = run_bash(
        'progress stamps shaders',
        f'unset MESA_SHADER_CACHE_DISABLE\n{QUICK_DRIVER}\n{environment}\ncompile_shaders', ROOT,
        venv=sys.prefix, stamps=str(stamps))
    assert code == 0, output
    return output


@pytest.mark.long
def test_the_shaders_are_compiled_once(tmp_path):
    """The first switch of the mode would take 10 s on a fresh machine, or every set-up would."""
    environment = f'export MESA_SHADER_CACHE_DIR={tmp_path}/cache'
    said = compile_shaders(tmp_path, environment)
    assert said.startswith(f'{COMPILING} ...\n')
    assert f'\n{COMPILING}: done in ' in said
    assert any(path.is_file() for path in (tmp_path / 'cache').rglob('*'))
    assert compile_shaders(tmp_path, environment) == ''
    (tmp_path / 'cache').rename(tmp_path / 'gone')
    said = compile_shaders(
        tmp_path, f'{environment} __EGL_VENDOR_LIBRARY_FILENAMES=/dev/null')
    assert said.startswith(f'{COMPILING} ...\n'), 'a cache that was removed is made again'


def test_without_a_cache_nothing_is_compiled(tmp_path):
    """The set-up would compile for nothing, and promise a quick first run."""
    said = compile_shaders(tmp_path, 'export MESA_SHADER_CACHE_DISABLE=true')
    assert 'compiled in every run' in said
    assert COMPILING not in said


def test_without_a_device_the_set_up_goes_on(tmp_path):
    """A machine that only builds, or gets its driver later, could not be set up."""
    said = compile_shaders(tmp_path, 'export __EGL_VENDOR_LIBRARY_FILENAMES=/dev/null')
    assert 'not done; the first run does it. there is no EGL device' in said
