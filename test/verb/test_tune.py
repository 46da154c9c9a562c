# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""`cloth_sim tune` measures this device, and runs use what it found."""

import json
import os
from pathlib import Path

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.resimulation.recorded_run import RecordedRun
from cloth_sim_ros.sim.device.tuning import Choice
from cloth_sim_ros.sim.device.tuning import read_tuning
from cloth_sim_ros.sim.device.tuning import VARIABLE
from cloth_sim_ros.verb.main import main
from command import cloth_sim
import pytest
from tuned_device import allow_tunings
from tuned_device import tune_device

SCENE = Path(__file__).resolve().parents[2] / 'config' / 'studies' / 'two_corners.yaml'
SMALL = (SCENE, '--set', 'rows=8', '--set', 'cols=9', '--seconds', 0.02)


@pytest.fixture(scope='module')
def device() -> tuple[str, str]:
    """Return the names of the device and its driver."""
    context = Context(single_thread=True)
    names = context.device, context.version
    context.close()
    return names


def run(*arguments: object) -> int:
    """Simulate a small cloth for a step or two."""
    return main(['run', *map(str, (*SMALL, *arguments))])


def recorded_choice(folder: Path, *arguments: object) -> Choice:
    """Return what a recorded run says it has used."""
    assert run('--record', folder, *arguments) == 0
    path, = folder.iterdir()
    scene = RecordedRun(Recording(path)).scene.scene()
    return Choice(scene['loads'], scene['block'])


def test_what_is_found_is_printed_and_kept(monkeypatch, tmp_path, device, capsys):
    """The next run would not know of it."""
    allow_tunings(monkeypatch, tmp_path)
    assert main(['tune', '--sizes', '9', '6', '--rounds', '1']) == 0
    title, *lines = capsys.readouterr().out.splitlines()
    assert title == f'{device[0]}, OpenGL {device[1]}'
    assert [line.partition(':')[0] for line in lines if 'built-in' in line][:2] == [
        '6 x 6', '9 x 9']
    tuning = read_tuning(*device)
    assert set(tuning.choices) == {6, 9}
    assert lines[-1].startswith(f'kept in {tmp_path}/cloth_sim_ros/tuning_')


def test_json_has_every_ratio(monkeypatch, tmp_path, device, capsys):
    """A tuning could not be looked into."""
    allow_tunings(monkeypatch, tmp_path)
    assert main(['tune', '--sizes', '6', '--rounds', '1', '--json']) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found['device'], found['rows']) == (device[0], 6)
    assert all(rival['ratios'] for rival in found['rivals'])
    assert vars(read_tuning(*device).choices[6]) == found['choice']


@pytest.mark.parametrize(('arguments', 'message'), [
    (('--sizes', '1'), '--sizes must be from 2 to 8192, got 1'),
    (('--sizes', *map(str, range(2, 70))), '--sizes takes up to 64 sizes, got 68'),
    (('--rounds', '0'), '--rounds must be from 1 to 1000, got 0')])
def test_what_cannot_be_measured_is_refused(
        monkeypatch, tmp_path, capsys, arguments, message):
    """A tuning would end in a traceback, or never."""
    allow_tunings(monkeypatch, tmp_path)
    assert main(['tune', *arguments]) == 1
    assert capsys.readouterr().err.startswith(f'cloth_sim tune: {message}')
    assert not list(tmp_path.iterdir())


def test_a_run_uses_and_records_it(monkeypatch, tmp_path, device):
    """A tuned device would be no faster, or a recording would not say how it was made."""
    tune_device(monkeypatch, tmp_path, *device, {16: Choice('storage', 2)})
    assert recorded_choice(tmp_path / 'tuned') == Choice('storage', 2)
    assert recorded_choice(tmp_path / 'own', '--set', 'block=3').block == 3


def test_no_tune_leaves_it_out(monkeypatch, tmp_path, device):
    """A run could not be compared with one that is not tuned."""
    tune_device(monkeypatch, tmp_path, *device, {16: Choice('storage', 3)})
    # What the option sets is gone after the test.
    monkeypatch.setenv(VARIABLE, '')
    assert recorded_choice(tmp_path / 'plain', '--no-tune').block != 3
    assert os.environ[VARIABLE] == 'off'


def test_a_broken_tuning_is_a_line_and_no_failure(monkeypatch, tmp_path, device):
    """A run would fail, or end in a traceback, because of a file that it can do without."""
    path = tune_device(monkeypatch, tmp_path, *device, {16: Choice('storage', 2)})
    path.write_text('{')
    done = cloth_sim('run', *map(str, SMALL), '--json')
    assert done.returncode == 0 and json.loads(done.stdout)['finite']
    line, = (line for line in done.stderr.splitlines() if 'compiling shaders' not in line)
    assert line.startswith(f'cloth_sim run: {path} is not the tuning of {device[0]} (')
