# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Runs are made once, by several processes, and none is lost."""

import json
import os
from pathlib import Path
import shutil
import signal
import subprocess
import sys
import time

import cloth_sim_ros
from cloth_sim_ros.study.make_runs import Forecast
from cloth_sim_ros.study.make_runs import in_minutes
from cloth_sim_ros.study.make_runs import make_runs
from cloth_sim_ros.study.results import DONE
from cloth_sim_ros.study.results import LINES
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.results import Run
from cloth_sim_ros.study.results import unmade
from cloth_sim_ros.study.workers import Workers
import pytest

SMALL = {'rows': 10, 'cols': 10}
LARGE = {'rows': 20, 'cols': 20}
SCENE = {'rows': 6, 'cols': 5}
ONE = Workers(jobs=1)
TWO = Workers(jobs=2)


def ended(run: Run, seconds: float):
    """Return the result of a run that took ``seconds``."""
    return unmade(run, DONE, '', wall_seconds=seconds)


def test_larger_runs_of_a_kind_are_expected_to_take_longer():
    """A study that begins with its largest runs would seem to take several times as long."""
    first, second = Run('m:f', LARGE, {'n': 1}), Run('m:f', SMALL, {'n': 2})
    forecast = Forecast([first, second])
    assert forecast.seconds_left(0.0) is None
    forecast.end(ended(first, 8.0))
    assert forecast.seconds_left(8.0) == pytest.approx(8.0 * 100 / 400)
    forecast.end(ended(second, 2.0))
    assert forecast.seconds_left(10.0) == 0.0


def test_each_mode_has_its_own_speed():
    """A slow mode at the end would come as a surprise."""
    runs = [Run('m:f', {**SMALL, 'mode': mode}, {'n': n})
            for n in range(2) for mode in ('mass_spring', 'constraint')]
    forecast = Forecast(runs)
    forecast.end(ended(runs[0], 1.0))
    assert forecast.seconds_left(1.0) == pytest.approx(3.0)
    forecast.end(ended(runs[1], 9.0))
    assert forecast.seconds_left(10.0) == pytest.approx(1.0 + 9.0)


def test_runs_side_by_side_take_less():
    """The forecast would be that of one process, however many make runs."""
    runs = [Run('m:f', SMALL, {'n': n}) for n in range(6)]
    forecast = Forecast(runs)
    for run in runs[:4]:
        forecast.end(ended(run, 10.0))
    # Two at a time: 4 runs of 10 s in 20 s.
    assert forecast.seconds_left(20.0) == pytest.approx(10.0)


@pytest.mark.parametrize(('seconds', 'told'), [
    (0.2, 'about 10 s'), (44.0, 'about 40 s'), (100.0, 'about 2 min'), (7300.0, 'about 2.0 h')])
def test_a_forecast_is_told_as_exactly_as_it_is_known(seconds: float, told: str):
    """Seconds would be counted of a guess."""
    assert in_minutes(seconds) == told


def squares(numbers, **settings):
    """Return runs that square these numbers."""
    return [Run('study_runs:square', {}, {'number': number, **settings}) for number in numbers]


def lines_of(folder):
    """Return the lines of a study's file."""
    return [json.loads(line) for line in (folder / LINES).read_text().splitlines()]


def make(runs, folder, workers=TWO, **options):
    """Make runs with two processes, or as many as given."""
    with ResultsFolder(folder) as results:
        return make_runs(runs, results, workers, title='test', **options)


def test_results_come_in_the_order_of_the_runs(tmp_path):
    """A result would be taken for that of another run."""
    results = make(squares([3, 1, 2, 3]), tmp_path)
    assert [result.values['square'] for result in results] == [9, 1, 4, 9]
    assert len(lines_of(tmp_path)) == 3


def test_work_is_spread(tmp_path):
    """All runs would be made by one process, or processes would fight for the processors."""
    place = tmp_path / 'place'
    place.mkdir()
    runs = [Run('study_runs:meet', {}, {'folder': str(place), 'name': name, 'others': 1})
            for name in 'ab']
    results = make(runs, tmp_path / 'study')
    assert [result.outcome for result in results] == ['done', 'done']
    assert {result.values['threads'] for result in results} == {'0'}


def test_a_run_is_made_once(tmp_path):
    """A continued study would repeat finished runs."""
    calls = tmp_path / 'calls'
    calls.mkdir()
    make(squares(range(3), folder=str(calls)), tmp_path / 'study', ONE)
    results = make(squares(range(5), folder=str(calls)), tmp_path / 'study', ONE)
    assert [result.values['square'] for result in results] == [0, 1, 4, 9, 16]
    assert len(list(calls.iterdir())) == 5


@pytest.fixture(scope='module')
def dropped(tmp_path_factory):
    """Let a cloth drop; return the folder, the run and its result."""
    folder = tmp_path_factory.mktemp('dropped')
    run = Run('study_runs:drop', SCENE, {'seconds': 0.01})
    result, = make([run], folder)
    return folder, run, result


def test_a_line_tells_what_it_is_of(dropped):
    """A result could not be made again, or be compared with another machine's."""
    line, = lines_of(dropped[0])
    assert line['scene'] == SCENE and line['settings'] == {'seconds': 0.01}
    assert line['outcome'] == 'done' and line['device'] and line['version']
    assert line['scene_sha256'] == Run('f', {**SCENE, 'cols': 5, 'dt': 0.005}).scene_sha256
    assert line['scene_sha256'] != Run('f', {**SCENE, 'dt': 0.004}).scene_sha256


def test_arrays_are_kept(dropped, tmp_path):
    """A continued study would have lost the positions it compares."""
    folder, run, first = dropped
    shutil.copytree(folder, tmp_path, dirs_exist_ok=True)
    again, = make([run], tmp_path)
    assert first.arrays['positions'].shape == (6, 5, 3)
    assert (again.arrays['positions'] == first.arrays['positions']).all()
    for path in (tmp_path / 'arrays').iterdir():
        path.write_bytes(b'half')
    repeated, = make([run], tmp_path)
    assert (repeated.arrays['positions'] == first.arrays['positions']).all()


def test_what_goes_wrong_is_a_line(tmp_path):
    """One bad run would end the study, or vanish from it."""
    runs = [
        Run('study_runs:drop', {**SCENE, 'rows': 0}, {'seconds': 0.01}),
        Run('study_runs:fail'), Run('study_runs:die'), *squares(range(4))]
    refused, failed, died, *rest = make(runs, tmp_path)
    assert refused.outcome == 'refused' and 'rows' in refused.reason
    assert failed.outcome == 'failed' and failed.reason == 'ZeroDivisionError: as asked'
    assert died.outcome == 'failed' and 'process ended' in died.reason
    assert [result.values['square'] for result in rest] == [0, 1, 4, 9]
    assert len(lines_of(tmp_path)) == len(runs)


def test_alone_each_run_has_a_fresh_process(tmp_path):
    """A measured wall time would hold what other runs do."""
    results = make(squares(range(2)), tmp_path, alone=True)
    assert len({result.values['process'] for result in results}) == 2
    threads = os.environ.get('LP_NUM_THREADS', '')
    assert {result.values['threads'] for result in results} == {threads}


@pytest.mark.parametrize('stop', [signal.SIGINT, signal.SIGKILL])
def test_a_stopped_study_goes_on(tmp_path, stop):
    """What was done would be lost, or processes would stay behind."""
    program = (
        'from cloth_sim_ros.study.make_runs import make_runs\n'
        'from cloth_sim_ros.study.results import ResultsFolder\n'
        'from cloth_sim_ros.study.results import Run\n'
        'from cloth_sim_ros.study.workers import Workers\n'
        'import os\n'
        'if __name__ == "__main__":\n'
        f'    runs = [Run("study_runs:square", {{}}, {{"number": n}}) for n in range(3)]\n'
        f'    runs.append(Run("study_runs:sleep", {{}}, {{"seconds": 60.0}}))\n'
        f'    with ResultsFolder({str(tmp_path)!r}) as results:\n'
        '        make_runs(runs, results, Workers(2), title="test")\n')
    script = tmp_path / 'study.py'
    script.write_text(program)
    # What pytest has put on the path of this process, the study needs as well.
    study = subprocess.Popen(
        [sys.executable, script], stderr=subprocess.PIPE,
        env={**os.environ, 'PYTHONPATH': os.pathsep.join(sys.path)},
        # In the background of a shell SIGINT is ignored, by all that is started there.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    deadline = time.monotonic() + 300.0
    while not ((tmp_path / LINES).exists() and len(lines_of(tmp_path)) == 3):
        assert time.monotonic() < deadline
        time.sleep(0.05)
    study.send_signal(stop)
    # Its end is the end of its workers, too: they hold the other end of this pipe.
    study.communicate(timeout=300.0)
    with open(tmp_path / LINES, 'a') as file:
        file.write('{"key": "half a li')
    results = make(squares(range(4)), tmp_path)
    assert [result.values['square'] for result in results] == [0, 1, 4, 9]
    assert len(lines_of(tmp_path)) == 4
    assert Path(script).exists()


def test_a_run_of_other_code_ends_the_study(tmp_path):
    """A study of two versions would end in a KeyError, or compare what differs."""
    root = Path(cloth_sim_ros.__file__).parent.parent
    for part in ('cloth_sim_ros', 'shaders'):
        shutil.copytree(
            root / part, tmp_path / part, ignore=shutil.ignore_patterns('__pycache__'))
    program = (
        'from cloth_sim_ros.sim.errors import ClothSimError\n'
        'from cloth_sim_ros.study.make_runs import make_runs\n'
        'from cloth_sim_ros.study.results import ResultsFolder\n'
        'from cloth_sim_ros.study.results import Run\n'
        'from cloth_sim_ros.study.workers import Workers\n'
        'if __name__ == "__main__":\n'
        '    with ResultsFolder("results") as results:\n'
        '        try:\n'
        '            make_runs([Run("study_runs:edit")], results, Workers(1), title="test")\n'
        '        except ClothSimError as error:\n'
        '            print(error)\n')
    study = subprocess.run(
        [sys.executable, '-c', program], cwd=tmp_path, capture_output=True, text=True,
        env={**os.environ, 'PYTHONPATH': os.pathsep.join([str(tmp_path), *sys.path])},
        timeout=300.0)
    assert study.stdout.startswith('a run was made by other code'), study.stderr
    assert not lines_of(tmp_path / 'results')
