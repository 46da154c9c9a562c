# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""`cloth_sim run` simulates a file, says what came out, and repeats itself bit for bit."""

from collections.abc import Callable
import json
from pathlib import Path
import signal
import subprocess
from subprocess import CompletedProcess
import sys
import time

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.summary import summarise
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from cloth_sim_ros.verb.main import main
from mcap.reader import make_reader
import numpy as np
import pytest

_SCENE = """/**:
  ros__parameters:
    rows: 9
    cols: 13
    material.preset: none
    start.jitter: 0.05
    dt: 0.004
    pushes:
      start: [0.1]
      duration: [0.05]
      force: [0.1, 0.0, 2.0]
    real_time_factor: 2.0
"""
_KEYS = [
    'mode', 'rows', 'cols', 'dt', 'substeps', 'sim_seconds', 'wall_seconds', 'steps',
    'node_steps_per_s', 'peak_strain', 'max_strain', 'kinetic_energy', 'total_energy', 'finite',
    'state_sha256', 'device']
Run = Callable[..., CompletedProcess]


@pytest.fixture(scope='module')
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give a scene file with a push and a parameter of the node."""
    path = tmp_path_factory.mktemp('scene') / 'scene.yaml'
    path.write_text(_SCENE)
    return path


def run_in_a_process(*arguments: object) -> CompletedProcess:
    """Call `cloth_sim run` in a process of its own."""
    return subprocess.run(
        [sys.executable, '-m', 'cloth_sim_ros.verb', 'run', *map(str, arguments)],
        capture_output=True, text=True)


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    """Return a function that calls `cloth_sim run` in this process."""

    def call(*arguments: object) -> CompletedProcess:
        capsys.readouterr()
        code = main(['run', *map(str, arguments)])
        return CompletedProcess(arguments, code, *capsys.readouterr())

    return call


def result_of(done: CompletedProcess) -> dict:
    """Return the JSON object of the last line."""
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


@pytest.fixture(scope='module')
def result(scene: Path) -> dict:
    """Return what a run of a second came to."""
    return result_of(run_in_a_process(scene, '--seconds', 1.0, '--json'))


def test_the_last_line_is_the_result(result: dict):
    """A script that reads the result would break."""
    assert list(result) == _KEYS
    assert (result['rows'], result['cols'], result['steps']) == (9, 13, 250)
    assert result['sim_seconds'] == pytest.approx(1.0)
    assert result['finite'] is True
    assert result['peak_strain'] >= result['max_strain'] > 0.0
    assert result['node_steps_per_s'] * result['wall_seconds'] == pytest.approx(
        9 * 13 * 250 * result['substeps'])


def test_two_processes_end_in_the_same_bits(scene: Path, result: dict):
    """A result could not be reproduced, not even on the same machine."""
    second = result_of(run_in_a_process(scene, '--seconds', 1.0, '--json'))
    assert second['state_sha256'] == result['state_sha256']


def test_the_state_is_written(run: Run, scene: Path, tmp_path: Path):
    """The end of a run could not be looked at."""
    out = tmp_path / 'state.npz'
    result_of(run(scene, '--seconds', 0.2, '--json', '--out', out))
    with np.load(out) as state:
        assert set(state) == {'positions', 'velocities', 'strain', 'flags', 'time'}
        assert state['positions'].shape == state['velocities'].shape == (9, 13, 3)
        assert state['strain'].shape == state['flags'].shape == (9, 13)
        assert state['flags'][0, 0] & FLAG_PINNED and not state['flags'][1, 1] & FLAG_PINNED
        assert state['time'] == pytest.approx(0.2)


def test_set_changes_a_parameter(run: Run, scene: Path):
    """A variation would need a file of its own."""
    result = result_of(run(
        scene, '--set', 'rows=5', '--set', 'pins=[top_edge]', '--seconds', 0.1, '--json'))
    assert result['rows'] == 5


def test_a_run_is_recorded(run: Run, scene: Path, tmp_path: Path):
    """The recording would lack frames or inputs."""
    done = run(scene, '--seconds', 0.2, '--record', tmp_path / 'bags',
               '--set', 'recording.name=fall')
    assert done.returncode == 0, done.stderr
    folder = tmp_path / 'bags' / 'fall'
    assert str(folder) in done.stdout
    with open(folder / 'fall_0.mcap', 'rb') as file:
        messages = [
            (channel.topic, message.log_time * 1e-9)
            for _, channel, message in make_reader(file).iter_messages()]
    times = [time for topic, time in messages if topic == '/cloth_sim/points']
    assert times == pytest.approx([frame * 0.02 for frame in range(11)])
    assert {topic for topic, _ in messages} >= {
        '/cloth_sim/stats', '/cloth_sim/pins/wrenches', '/cloth_sim/state', '/cloth_sim/topology',
        '/cloth_sim/inputs/parameters', '/cloth_sim/inputs/push'}


def test_the_peak_strain_is_that_of_the_recording(run: Run, scene: Path, tmp_path: Path):
    """A start that is the most stretched would count in `cloth_sim info` alone."""
    result = result_of(run(
        scene, '--seconds', 0.2, '--json', '--record', tmp_path, '--set', 'recording.name=bag',
        '--set', 'start.jitter=0.3', '--set', 'pushes.force=[0.0, 0.0, 0.1]'))
    recording = Recording(tmp_path / 'bag')
    start = next(entry.message for entry in recording.entries('stats'))
    assert result['peak_strain'] == start.max_strain == summarise(recording).largest_strain
    assert result['peak_strain'] > result['max_strain']


def test_no_time_at_all_shows_the_start(run: Run, scene: Path):
    """The start pose could not be looked at."""
    result = result_of(run(scene, '--seconds', 0, '--json'))
    assert result['steps'] == 0
    assert result['peak_strain'] == result['max_strain'] > 0.0


@pytest.mark.parametrize(('seconds', 'dt'), [(0.02, 1.0), (0.00499, 0.005)])
def test_a_run_shorter_than_a_step_is_refused(
        run: Run, scene: Path, tmp_path: Path, seconds: float, dt: float):
    """Nothing would be simulated, and all of it be done."""
    done = run(scene, '--seconds', seconds, '--set', f'dt={dt}', '--record', tmp_path / 'bags')
    assert (done.returncode, done.stdout) == (1, '')
    assert done.stderr == (
        f'cloth_sim run: --seconds {seconds} is shorter than one step, dt {dt} s, so nothing '
        f'would move: give --seconds {dt} or more, or set a shorter dt\n')
    assert not (tmp_path / 'bags').exists()
    assert result_of(run(scene, '--seconds', dt, '--set', f'dt={dt}', '--json'))['steps'] == 1


@pytest.mark.parametrize(('number', 'code'), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_completes_the_recording(
        scene: Path, tmp_path: Path, number: signal.Signals, code: int):
    """A run that is stopped would leave a file that is cut off, without a word."""
    bag = tmp_path / 'bag'
    # One that was started in the background of a shell may ignore SIGINT.
    process = subprocess.Popen(
        [sys.executable, '-m', 'cloth_sim_ros.verb', 'run', scene, '--seconds', '100000',
         '--record', tmp_path, '--set', 'recording.name=bag'],
        stderr=subprocess.PIPE, text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
    while not (bag / 'bag_0.mcap').exists() or (bag / 'bag_0.mcap').stat().st_size < 100_000:
        assert process.poll() is None
        time.sleep(0.05)
    process.send_signal(number)
    said = process.communicate(timeout=300)[1]
    assert process.returncode == code
    recording = Recording(bag)
    # The cloud of a frame that has no statistics may come after.
    end = recording.arrays('stats')['time'][-1]
    assert recording.problems == []
    # A machine that is slow to compile says so first.
    assert said.removeprefix('compiling shaders for mode mass_spring ...\n') == (
        f'cloth_sim run: interrupted; the recording {bag} is complete up to {end:.6g} s\n')


@pytest.mark.parametrize(('arguments', 'message'), [
    (['--set', 'rwos=3'], 'there is no parameter rwos: did you mean rows?'),
    (['--set', 'rows'], "a change needs name=value, got 'rows'"),
    (['--set', 'dt=0.0'], 'dt 0.0 is outside its range'),
    (['--set', 'mode=rigid'], 'mode must be one of'),
    (['--set', 'rows=5000', '--set', 'cols=5000'], 'the buffers of'),
    (['--seconds', 'nan'], '--seconds must be a finite time'),
    (['--out', '/proc/nothing/state.npz'], 'cannot be written'),
    (['--record', '/proc/nothing'], 'set --record to a writable folder'),
])
def test_what_is_wrong_is_said_in_one_line(
        run: Run, scene: Path, arguments: list[str], message: str):
    """The user would get a traceback."""
    done = run(scene, *arguments)
    assert done.returncode == 1
    assert message in done.stderr
    assert 'Traceback' not in done.stderr


def test_a_blow_up_is_a_failure_that_says_when(run: Run, scene: Path, tmp_path: Path):
    """A run of NaN would look like a result, or leave files that can't be read."""
    violent = tmp_path / 'violent.yaml'
    # So light and pushed so hard that squared distances leave the range of float32.
    violent.write_text(
        _SCENE.replace('force: [0.1, 0.0, 2.0]', 'force: [0.0, 0.0, 1.0e9]')
        + '    node_mass: 1.0e-16\n    stiffness: {structural: 1e-12, shear: 0.0, bend: 0.0}\n'
        '    damping: {structural: 0.0, shear: 0.0, bend: 0.0}\n')
    out = tmp_path / 'last.npz'
    done = run(violent, '--seconds', 0.3, '--json', '--out', out, '--record', tmp_path,
               '--set', 'recording.name=lost')
    assert done.returncode == 1
    result = json.loads(done.stdout.splitlines()[-1])
    assert result['finite'] is False
    assert result['sim_seconds'] == pytest.approx(0.1)
    [line] = [line for line in done.stderr.splitlines() if 'non-finite' in line]
    assert 'in the step from t = 0.1 s' in line and 'push with less force' in line
    assert 'Traceback' not in done.stderr
    with np.load(out) as state:
        assert state['time'] == pytest.approx(0.1)
        assert np.isfinite(state['positions']).all()
    summary = summarise(Recording(tmp_path / 'lost'))
    assert not summary.finite
    assert summary.end == pytest.approx(0.1)
