# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The demo, as a user runs it."""

from contextlib import contextmanager
import os
from pathlib import Path
import signal
import subprocess

from matplotlib.image import imread
import pytest
from rosbags.highlevel import AnyReader
from session_processes import kill_all_of
from session_processes import processes_of

DEMO = Path(__file__).resolve().parents[1] / 'scripts' / 'demo.sh'
PATIENCE = 300.0
# Simulated time at which the demo pushes, switches the mode and lets a corner go [s]; the last one
# comes after a part in real time.
PUSHES = [1.0, 1.4]
SWITCHES = [1.7, 1.8, 1.9]


@contextmanager
def demo(folder, *arguments, **environment):
    """Start the demo in a session of its own, with little more than a home and a path."""
    process = subprocess.Popen(
        [DEMO, *arguments], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        text=True, start_new_session=True,
        env={
            'HOME': os.environ.get('HOME', str(folder)), 'PATH': os.environ['PATH'],
            **environment},
        # A shell that was started with SIGINT ignored can't trap it.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    try:
        yield process
    finally:
        kill_all_of(process.pid)
        process.wait()
        process.stdout.close()


def recording_in(folder):
    """Return the one recording in ``folder``."""
    bag, = (path for path in folder.iterdir() if path.is_dir())
    return bag


def recorded_topics(folder):
    """Return the number of messages of each topic in the one recording in ``folder``."""
    with AnyReader([recording_in(folder)]) as reader:
        return {connection.topic: connection.msgcount for connection in reader.connections}


def recorded_times(folder, topic):
    """Return the simulated times [s] of the messages of a topic of the node."""
    with AnyReader([recording_in(folder)]) as reader:
        return [
            time / 1e9 for connection, time, _ in reader.messages()
            if connection.topic == f'/cloth_sim/{topic}']


def acts_at_its_times(folder):
    """Return whether the demo did what it does at the simulated times it has for that."""
    switches = recorded_times(folder, 'inputs/mode')[1:]  # the first one is the mode at the start
    return (
        recorded_times(folder, 'inputs/push') == pytest.approx(PUSHES)
        and switches == pytest.approx(SWITCHES)
        and recorded_times(folder, 'points')[:101] == pytest.approx(
            [0.02 * number for number in range(101)]))


@pytest.fixture(scope='module')
def finished(tmp_path_factory):
    """
    Run the demo to its end as a new user does; return its folder, output, exit code and leftovers.

    Without a shader cache: it would fail while the driver compiles. It compiles for some seconds
    even where it does not optimise.
    """
    folder = tmp_path_factory.mktemp('demo')
    (folder / 'cache').mkdir()
    with demo(
            folder, 'bags', MESA_SHADER_CACHE_DISABLE='true', GALLIVM_PERF='nopt',
            XDG_CACHE_HOME=str(folder / 'cache')) as process:
        # PATIENCE is that of one answer.
        output = process.communicate(timeout=4.0 * PATIENCE)[0]
        return folder / 'bags', output, process.returncode, processes_of(process.pid)


def test_it_ends_well_and_leaves_no_process(finished):
    """A user's first command would fail, or leave a node running for ever."""
    _, output, returncode, left = finished
    assert returncode == 0, output
    assert left == []
    assert 'MESA_SHADER_CACHE_DISABLE' in output


def test_its_recording_holds_all_that_was_done(finished):
    """The recording could not be played or analysed, or would miss what the demo did."""
    folder, output, _, _ = finished
    counts = recorded_topics(folder)
    assert counts['/cloth_sim/points'] > 50, output
    assert counts['/cloth_sim/stats'] == counts['/cloth_sim/points']
    assert counts['/cloth_sim/inputs/push'] == 2
    assert counts['/cloth_sim/inputs/pin'] == 1
    assert counts['/cloth_sim/topology'] == 1


def test_it_acts_in_simulated_time(finished):
    """On a slow machine it would push another cloth than on a fast one, at other nodes."""
    assert acts_at_its_times(finished[0])


def test_it_makes_a_picture(finished):
    """The picture it names would not be there, or be empty."""
    folder, output, _, _ = finished
    file, = folder.glob('*.png')
    assert str(file) in output
    picture = imread(file)
    assert picture.shape[1] > 1000
    assert picture[..., :3].std() > 0.05


def test_it_tells_what_happened(finished):
    """A user would not learn what ran where, how fast, and where the results are."""
    folder, output, _, _ = finished
    bag = recording_in(folder)
    for words in ('device', 'real-time factor', 'max strain', 'total energy', str(bag),
                  'mode mass_spring', '200 steps done', 'has ended'):
        assert words in output


@pytest.mark.parametrize('number', [
    signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.long)])
def test_stopped_early_it_cleans_up(tmp_path, number):
    """Ctrl-C in the demo would leave a node behind, or lose the recording."""
    with demo(tmp_path, 'bags') as process:
        lines = iter(process.stdout.readline, '')
        assert any(line.startswith('Pushing') for line in lines)
        os.killpg(process.pid, number)
        rest = process.communicate(timeout=PATIENCE)[0]
        assert process.returncode == 128 + number
        assert processes_of(process.pid) == []
    assert 'stopped early' in rest
    bags = tmp_path / 'bags'
    assert f'what was recorded until then: {recording_in(bags)}\n' in rest
    assert recorded_topics(bags)['/cloth_sim/points'] > 0


def test_a_folder_that_cannot_be_written_is_told(tmp_path):
    """The demo would hang, or end without a reason."""
    (tmp_path / 'file').write_text('')
    with demo(tmp_path, 'file/bags') as process:
        output = process.communicate(timeout=PATIENCE)[0]
        assert process.returncode == 1
        assert processes_of(process.pid) == []
    assert 'cannot record into' in output
