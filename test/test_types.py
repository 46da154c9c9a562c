# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Hold the types to what the code does."""

from pathlib import Path
import re
import subprocess
import sys

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / 'cloth_sim_ros'
# What mypy has read, from one run to the next: it reads anew what has changed since.
CACHE = ROOT / '.mypy_cache'


def check_types(*arguments, **options):
    """Return what mypy says of ``arguments``, with the settings of setup.cfg."""
    done = subprocess.run(
        [sys.executable, '-m', 'mypy', '--config-file', str(ROOT / 'setup.cfg'),
         '--cache-dir', str(CACHE), *arguments],
        capture_output=True, text=True, timeout=1200, **options)
    return done.stdout + done.stderr


def test_the_whole_package_is_typed():
    """An editor or a type checker would tell users what is not so, and us too little."""
    said = check_types(str(PACKAGE), *map(str, sorted(ROOT.glob('examples/*.py'))), cwd=ROOT)
    found = re.match(r'Success: no issues found in (\d+) source files', said)
    assert found, said
    # Neither a folder nor a file is left out by the settings.
    assert int(found[1]) >= len([*PACKAGE.rglob('*.py')])


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
    said = check_types(str(program), cwd=ROOT)
    assert [line.split(':')[1] for line in said.splitlines() if ': error:' in line] == [
        '3', '4', '5'], said
