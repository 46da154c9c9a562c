# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Hold the types of the Python API to what the code does."""

from pathlib import Path
import subprocess
import sys

import cloth_sim_ros

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / 'cloth_sim_ros'


def check_types(*arguments, **options):
    """Return what mypy says of ``arguments``, with the settings of setup.cfg."""
    done = subprocess.run(
        [sys.executable, '-m', 'mypy', '--config-file', str(ROOT / 'setup.cfg'), *arguments],
        capture_output=True, text=True, timeout=300, **options)
    return done.stdout + done.stderr


def test_the_public_modules_are_typed_throughout(tmp_path):
    """An editor or a type checker would tell users what is not so."""
    modules = {
        PACKAGE / f'{name.replace(".", "/")}.py' for name in cloth_sim_ros._MODULES.values()}
    files = sorted({PACKAGE / '__init__.pyi', *modules, *PACKAGE.glob('api/*.py'),
                    *PACKAGE.glob('gym/*.py'), *ROOT.glob('examples/*.py')})
    said = check_types('--cache-dir', str(tmp_path), *map(str, files), cwd=ROOT)
    assert said.startswith('Success: no issues found'), said


def test_a_mistake_in_a_program_is_found(tmp_path):
    """The types would be there, and say nothing."""
    program = tmp_path / 'program.py'
    program.write_text(
        'from cloth_sim_ros import Recording, Scene, Simulation\n'
        'with Simulation(Scene({"rows": 4})) as cloth:\n'
        '    cloth.advance("long")\n'
        '    cloth.positions().no_such_attribute\n'
        '    cloth.snapshot(forces=True)\n'
        'Recording("bag").arrays("points")["time"].shape\n', encoding='utf-8')
    said = check_types('--cache-dir', str(tmp_path / 'cache'), str(program), cwd=ROOT)
    assert [line.split(':')[1] for line in said.splitlines() if ': error:' in line] == [
        '3', '4', '5'], said
