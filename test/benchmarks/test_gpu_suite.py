# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The suite for a GPU runs whole on a CPU, and loses nothing where a section fails."""

from collections.abc import Iterator
import json
import os
from pathlib import Path
import shutil
import signal
import subprocess
import sys

from gpu.section import FAULT
from gpu.section import in_words
from gpu.section import Row
from gpu.section import run_section
from gpu.section import Section
from gpu_suite import read_arguments
from gpu_suite import SECTIONS
import pytest

ROOT = Path(__file__).resolve().parents[2]


def run(folder: Path, *arguments: str, root: Path = ROOT) -> subprocess.CompletedProcess[str]:
    """Run the suite of ``root`` with its results in ``folder``."""
    return subprocess.run(
        [sys.executable, str(root / 'benchmarks/gpu_suite.py'), '--quick', '--out', str(folder),
         *arguments], capture_output=True, text=True,
        env={**os.environ, 'LP_NUM_THREADS': '0', 'PYTHONPATH': str(ROOT)})


def sections_of(folder: Path) -> dict[str, dict]:
    """Return what the JSON says of each section."""
    content = json.loads((folder / 'gpu_suite.json').read_text(encoding='utf-8'))
    return {section['name']: section for section in content['sections']}


@pytest.mark.long
def test_all_sections_pass_on_llvmpipe(tmp_path: Path):
    """Whoever has a GPU for half an hour would find a suite that no longer runs."""
    done = run(tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    found = sections_of(tmp_path)
    assert list(found) == [section.name for section in SECTIONS]
    page = (tmp_path / 'gpu_suite.md').read_text(encoding='utf-8')
    for section in SECTIONS:
        assert found[section.name]['rows'] and found[section.name]['status'] == 'ok'
        assert f'## {section.title}\n' in page
    cases = found['states']['rows']
    assert len(cases) == 20 and all(case['same bits twice'] for case in cases)


def test_a_section_that_fails_is_reported(tmp_path: Path):
    """The sections behind it would be lost, or the fault overlooked."""
    root = tmp_path / 'copy'
    for name in ('benchmarks', 'shaders'):
        shutil.copytree(
            ROOT / name, root / name, ignore=shutil.ignore_patterns('__pycache__'))
    (root / 'benchmarks/gpu/states.npz').unlink()
    done = run(tmp_path / 'out', '--sections', 'device', 'states', 'dispatches', root=root)
    assert done.returncode == 1
    found = sections_of(tmp_path / 'out')
    assert [each['status'] for each in found.values()] == ['ok', 'failed', 'ok']
    assert 'states.npz' in found['states']['error'] and 'not ok: states' in done.stdout


def test_a_section_ends_at_its_time_limit():
    """One section that hangs would take the time of all others."""
    section = next(each for each in SECTIONS if each.name == 'modes')
    outcome = run_section(section, True, 0.05)
    assert outcome.status == 'time limit' and outcome.rows == []


def test_an_interrupt_keeps_what_was_measured(tmp_path: Path):
    """Half an hour with a GPU would be lost."""
    process = subprocess.Popen(
        [sys.executable, str(ROOT / 'benchmarks/gpu_suite.py'), '--out', str(tmp_path),
         '--sections', 'device', 'springs'], stdout=subprocess.PIPE, text=True,
        env={**os.environ, 'LP_NUM_THREADS': '0'}, start_new_session=True)
    assert process.stdout
    for line in process.stdout:
        if 'side 32' in line:
            break
    os.killpg(process.pid, signal.SIGINT)
    assert 'interrupted' in process.stdout.read()
    assert process.wait() == 130
    found = sections_of(tmp_path)
    assert found['device']['status'] == 'ok' and found['springs']['status'] == 'interrupted'
    assert found['springs']['rows'][0]['side'] == 32


def test_a_fault_is_a_status_of_its_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    """A device that computes wrongly would be listed as ok."""
    from gpu.section import run_here

    def measure(quick: bool) -> Iterator[Row]:
        yield {'case': 'springs', FAULT: 'far from llvmpipe'}
        raise ValueError('no more')

    path = tmp_path / 'rows'
    assert run_here(Section('states', 'States', 1.0, measure), path, True) == 1
    assert json.loads(path.read_text(encoding='utf-8'))[FAULT] == 'far from llvmpipe'
    assert in_words({'a': 0.5, 'b': 3}) == 'a 0.5, b 3'
    assert 'no more' in capsys.readouterr().err


def test_sections_are_chosen_by_name():
    """A typing error would run the whole suite, or nothing."""
    assert read_arguments(['--sections', 'states']).sections == ['states']
    with pytest.raises(SystemExit):
        read_arguments(['--sections', 'state'])
