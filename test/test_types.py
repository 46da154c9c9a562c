# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Hold the types to what the code does."""

from pathlib import Path
import re
import subprocess
import sys

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / 'cloth_sim_ros'


@pytest.fixture(scope='module')
def cache(tmp_path_factory):
    """Return a folder that mypy keeps what it has read in, from one test to the next."""
    return tmp_path_factory.mktemp('types')


def check_types(*arguments, **options):
    """Return what mypy says of ``arguments``, with the settings of setup.cfg."""
    done = subprocess.run(
        [sys.executable, '-m', 'mypy', '--config-file', str(ROOT / 'setup.cfg'), *arguments],
        capture_output=True, text=True, timeout=300, **options)
    return done.stdout + done.stderr


def test_the_whole_package_is_typed(cache):
    """An editor or a type checker would tell users what is not so, and us too little."""
    said = check_types(
        '--cache-dir', str(cache), str(PACKAGE), *map(str, sorted(ROOT.glob('examples/*.py'))),
        cwd=ROOT)
    found = re.match(r'Success: no issues found in (\d+) source files', said)
    assert found, said
    # Neither a folder nor a file is left out by the settings.
    assert int(found[1]) >= len([*PACKAGE.rglob('*.py')])


def test_a_mistake_in_a_program_is_found(tmp_path, cache):
    """The types would be there, and say nothing."""
    program = tmp_path / 'program.py'
    program.write_text(
        'from cloth_sim_ros import Recording, Scene, Simulation\n'
        'with Simulation(Scene({"rows": 4})) as cloth:\n'
        '    cloth.advance("long")\n'
        '    cloth.positions().no_such_attribute\n'
        '    cloth.snapshot(forces=True)\n'
        'Recording("bag").arrays("points")["time"].shape\n', encoding='utf-8')
    said = check_types('--cache-dir', str(cache), str(program), cwd=ROOT)
    assert [line.split(':')[1] for line in said.splitlines() if ': error:' in line] == [
        '3', '4', '5'], said
