# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Split recordings, and recordings made whole, by the command line."""

from pathlib import Path
import shutil
import subprocess
import sys
import time

from cloth_sim_ros.analysis.comparison import compare
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.verb.main import main
import pytest
from rosbags.highlevel import AnyReader

ROOT = Path(__file__).resolve().parents[2]


def run(folder: Path, *options: str, name: str = 'small') -> Path:
    """Return the folder of a recording of 2.5 s."""
    assert main([
        'run', str(ROOT / 'config' / 'curtain.yaml'), '--seconds', '2.5', '--record', str(folder),
        '--set', 'rows=8', '--set', 'cols=46', '--set', f'recording.name={name}', *options]) == 0
    return folder / name


@pytest.fixture(scope='module')
def whole(tmp_path_factory) -> Path:
    """Return a recording of one file."""
    return run(tmp_path_factory.mktemp('whole'))


@pytest.fixture(scope='module')
def split(tmp_path_factory) -> Path:
    """Return a recording of three files."""
    path = run(tmp_path_factory.mktemp('split'), '--max-bag-duration', '1', '--fsync')
    assert len(list(path.glob('*.mcap'))) == 3
    return path


def clouds(path: Path) -> int:
    """Return the number of clouds that rosbags reads."""
    with AnyReader([path]) as reader:
        return sum(
            connection.topic == '/cloth_sim/points' for connection, _, _ in reader.messages())


def test_a_split_recording_is_the_same_run(whole, split, tmp_path, capsys):
    """Figures, pictures and the run made again would be of the first file alone."""
    assert compare(Recording(whole), Recording(split)).identical
    assert main(['resimulate', str(split)]) == 0
    assert '126 frames' in capsys.readouterr().out
    assert main(['render', str(split), '--out', str(tmp_path / 'a.png'), '--at', '2.4']) == 0
    assert (tmp_path / 'a.png').stat().st_size > 1000


def test_markers_are_recorded_on_request(whole, tmp_path):
    """A viewer would show the nodes alone, and what the cloth lies on not at all."""
    def topics(path: Path) -> set[str]:
        with AnyReader([path]) as reader:
            return {each.topic for each in reader.connections if each.msgcount}
    drawn = topics(run(tmp_path, '--markers'))
    assert drawn - topics(whole) == {'/cloth_sim/markers'}


def test_one_file_of_a_split_recording_shows_the_cloth(split, tmp_path, capsys):
    """A file that is sent alone could not be drawn."""
    alone = shutil.copy(split / 'small_1.mcap', tmp_path)
    assert main(['info', alone]) == 0
    assert '1 to 1.98 s, 50 frames' in capsys.readouterr().out
    assert main(['render', alone, '--out', str(tmp_path / 'a.png'), '--at', '1.5']) == 0


def test_a_limited_recording_is_whole_and_the_run_goes_on(tmp_path, capsys):
    """A run would end, or fail, when its recording has the size that was asked for."""
    path = run(tmp_path, '--max-recording-size', str(2**20))
    output = capsys.readouterr()
    assert f'cloth_sim run: the recording {path} is complete up to ' in output.err
    assert 'sim_seconds       2.5' in output.out
    assert sum(file.stat().st_size for file in path.iterdir()) <= 2**20
    assert 10 < clouds(path) < 126


def test_sizes_that_hold_nothing_are_refused(tmp_path, capsys):
    """A recording would be made of thousands of files, or of none."""
    for option, value, least in (
            ('--max-bag-size', '1000', '1048576'), ('--max-bag-duration', '0.5', '1.0'),
            ('--max-recording-size', '1000', '1048576')):
        assert main([
            'run', str(ROOT / 'config' / 'curtain.yaml'), '--record', str(tmp_path / 'bags'),
            option, value]) == 1
        assert f'must be 0 or {least} and more, got {value}' in capsys.readouterr().err
    assert not (tmp_path / 'bags').exists()


def test_lost_recording_fails_but_keeps_the_result(tmp_path):
    """A script would believe that a run is recorded, or lose the result with the recording."""
    folder = tmp_path / 'bags'
    process = subprocess.Popen(
        [sys.executable, '-m', 'cloth_sim_ros.verb', 'run', ROOT / 'config' / 'curtain.yaml',
         '--seconds', '10', '--record', folder, '--set', 'rows=8', '--set', 'cols=46', '--set',
         'recording.name=small'], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not (folder / 'small' / 'metadata.yaml').exists():
        assert process.poll() is None
        time.sleep(0.02)
    (folder / 'small' / 'small_0.mcap').unlink()
    output, errors = process.communicate(timeout=300)
    assert process.returncode == 1
    assert 'has stopped (small_0.mcap was removed or replaced by another program)' in errors
    assert 'sim_seconds       10' in output


def test_recover_prints_what_was_kept(whole, tmp_path, capsys):
    """A user would not know how much of a killed run is left, or where."""
    folder = shutil.copytree(whole, tmp_path / 'killed')
    file = folder / 'small_0.mcap'
    file.write_bytes(file.read_bytes()[:int(0.7 * file.stat().st_size)])
    capsys.readouterr()
    assert main(['recover', str(folder)]) == 0
    missing, kept, path = capsys.readouterr().out.splitlines()
    assert missing.startswith('small_0.mcap lacks everything after its first ')
    assert path == str(tmp_path / 'killed_recovered')
    assert kept.startswith('kept ') and ' s, up to ' in kept
    end = float(kept.split(' up to ')[1].split()[0])
    assert clouds(Path(path)) == pytest.approx(1 + end / 0.02, abs=1.0)
    assert main(['recover', str(folder)]) == 1
    assert 'already exists' in capsys.readouterr().err
    assert main(['recover', str(file), '--out', str(tmp_path / 'other')]) == 0
    assert clouds(tmp_path / 'other') == clouds(Path(path))
    assert main(['resimulate', path]) == 0


def test_recover_leaves_a_whole_recording_alone(split, capsys):
    """A user would double a recording for nothing."""
    before = sorted(split.parent.iterdir())
    assert main(['recover', str(split)]) == 0
    assert capsys.readouterr().out.startswith(f'{split} is complete: ')
    assert sorted(split.parent.iterdir()) == before
