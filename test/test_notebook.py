# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The notebook of the tutorial runs, and its page shows what it shows."""

import json
from pathlib import Path
import re
import subprocess
import sys

import pytest

ROOT = Path(__file__).resolve().parents[1]
NOTEBOOK = ROOT / 'docs' / 'tutorial' / 'python_notebook.ipynb'
NUMBER = re.compile(r'-?\d+(?:\.\d+)?')


def write(*arguments):
    """Run the script that writes the page."""
    return subprocess.run(
        [sys.executable, str(ROOT / 'scripts' / 'notebook_page.py'), *map(str, arguments)],
        capture_output=True, text=True, timeout=600)


def outputs(path):
    """Return what the cells of a notebook have printed, and how many pictures each has."""
    cells = json.loads(path.read_text(encoding='utf-8'))['cells']
    shown = [cell['outputs'] for cell in cells if cell['cell_type'] == 'code']
    printed = ''.join(
        line for each in shown for output in each for line in output.get('text', ()))
    return printed, [sum('data' in output for output in each) for each in shown]


def test_it_runs_and_shows_what_the_page_has(tmp_path):
    """A cell of the first notebook a user opens would fail, or show something else."""
    done = write('--out', tmp_path)
    assert done.returncode == 0, done.stderr
    printed, pictures = outputs(tmp_path / NOTEBOOK.name)
    shown, shown_pictures = outputs(NOTEBOOK)
    assert pictures == shown_pictures and sum(pictures) == 2
    # Devices round differently.
    assert NUMBER.sub('', printed) == NUMBER.sub('', shown)
    assert [*map(float, NUMBER.findall(printed))] == pytest.approx(
        [*map(float, NUMBER.findall(shown))], rel=0.02, abs=0.02)
    assert (tmp_path / 'python_notebook_2.png').read_bytes().startswith(b'\x89PNG')


def test_the_page_is_that_of_the_notebook():
    """The page would show an older notebook than the one that it offers."""
    done = write('--check')
    assert done.returncode == 0, done.stderr


def test_an_old_page_is_found(tmp_path):
    """A change of the notebook could be forgotten in the page."""
    done = write('--check', '--out', tmp_path)
    assert done.returncode == 1
    assert 'python_notebook.md is not what' in done.stderr


def test_jupyter_takes_it_for_a_notebook():
    """Jupyter would refuse to open it."""
    notebook = json.loads(NOTEBOOK.read_text(encoding='utf-8'))
    assert notebook['nbformat'] == 4 and notebook['nbformat_minor'] >= 5
    ids = [cell['id'] for cell in notebook['cells']]
    assert len(set(ids)) == len(ids)
    for cell in notebook['cells']:
        code = {'execution_count', 'outputs'} if cell['cell_type'] == 'code' else set()
        assert set(cell) == {'cell_type', 'id', 'metadata', 'source'} | code
