# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The page on the Python API says what is so."""

from pathlib import Path
import re
import subprocess
import sys

import cloth_sim_ros

PAGE = Path(__file__).resolve().parents[1] / 'docs' / 'how_to' / 'python_api.md'


def test_its_blocks_run_one_after_the_other(tmp_path):
    """The first program of a user would fail."""
    blocks = re.findall(r'```python\n(.*?)```', PAGE.read_text(encoding='utf-8'), re.DOTALL)
    assert len(blocks) == 5
    done = subprocess.run(
        [sys.executable, '-c', '\n'.join(blocks)], cwd=tmp_path, capture_output=True, text=True,
        timeout=600)
    assert done.returncode == 0, done.stderr
    assert '36 of 36 frames bitwise identical' in done.stdout
    assert '(36,) (36, 32, 32, 3)' in done.stdout


def test_the_calls_of_its_table_are_there():
    """A user would look for a method of another version."""
    rows = re.findall(r'^\| [^|]+ \| (`[^|]+) \|', PAGE.read_text(encoding='utf-8'), re.MULTILINE)
    names = {name for row in rows for name in re.findall(r'`(\w+)\(', row)}
    assert len(names) == 20
    assert {name for name in names if not hasattr(cloth_sim_ros.Simulation, name)} == set()
