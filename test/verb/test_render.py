# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Drawing recordings from the command line."""

from pathlib import Path

from cloth_sim_ros.verb.main import main
from matplotlib.image import imread
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope='module')
def run(tmp_path_factory):
    """Record a short run of the shipped scene, made small, and write its last state."""
    folder = tmp_path_factory.mktemp('bags')
    assert main([
        'run', str(ROOT / 'config' / 'studies' / 'two_corners.yaml'), '--seconds', '0.2',
        '--record', str(folder), '--set', 'rows=6', '--set', 'cols=7',
        '--set', 'recording.name=small', '--out', str(folder / 'small.npz')]) == 0
    return folder


@pytest.fixture
def render(run, tmp_path, capsys):
    """Return a function that renders with some arguments and returns the image."""

    def draw(*arguments, sources=('small',)):
        file = tmp_path / f'{len(list(tmp_path.iterdir()))}.png'
        assert main([
            'render', *(str(run / source) for source in sources), '--out', str(file),
            '--size', '120x90', *arguments]) == 0
        assert capsys.readouterr().out.strip() == str(file)
        return imread(file)

    return draw


@pytest.fixture(scope='module')
def kept():
    """Keep a picture by what was asked for, from one test to the next."""
    return {}


def test_draws_the_times_asked_for(render):
    """The picture would have other panels than asked for."""
    one, two, six = render('--at', '0.1'), render('--at', '0.1,0.2'), render()
    assert two.shape[1] > one.shape[1] + 110
    assert six.shape[0] > one.shape[0] + 80
    assert render('--at', '0,0.1,0.2', '--columns', '1').shape[0] > one.shape[0] + 170


@pytest.mark.parametrize('arguments', [
    ('--azimuth', '40'), ('--elevation', '70'), ('--fov', '0'), ('--zoom', '2'),
    ('--target', '0.5', '0.5', '1'), ('--strain-max', '0.001'), ('--title', 'mine')])
def test_the_look_can_be_chosen(render, kept, arguments):
    """An option would do nothing."""
    if 'plain' not in kept:
        kept['plain'] = render('--at', '0.2')
    plain, changed = kept['plain'], render('--at', '0.2', *arguments)
    assert plain.shape == changed.shape
    assert np.abs(plain - changed).max() > 0.3


def test_a_state_looks_like_the_recording_at_its_end(render):
    """A state file would be drawn as another cloth than it was written from."""
    state = render('--title', '', sources=['small.npz'])
    recorded = render('--at', '0.2', '--title', '')
    # The panel of the sheet; the recording's note names the device.
    difference = np.abs(state - recorded)[:100, :120].max(axis=-1)
    assert (difference > 0.1).mean() < 0.005


def test_recordings_stand_side_by_side(render):
    """Two runs could not be compared."""
    both = render(
        '--at', '0.1,0.2', '--labels', 'one', 'two', sources=['small', 'small.npz'])
    assert both.shape[0] > 220


def test_writes_a_video(run, tmp_path, capsys):
    """The command of the README would not make a video."""
    file = tmp_path / 'run.mp4'
    assert main([
        'render', str(run / 'small'), '--video', str(file), '--size', '160x120', '--fps', '10',
        '--speed', '0.5']) == 0
    assert capsys.readouterr().out.strip() == str(file)
    assert file.stat().st_size > 1000


@pytest.mark.parametrize(('arguments', 'complaint'), [
    (['--at', 'soon'], 'write them as in 0.5,1,2'), (['--at', '0.1,,0.2'], 'as in 0.5,1,2'),
    (['--at', 'nan'], 'as in 0.5,1,2'), (['--at', ''], 'as in 0.5,1,2'),
    (['--size', '640'], 'write it as in 640x480'), (['--size', '5x5'], 'from 32 to 8192 pixels'),
])
def test_refuses_arguments_that_are_none(run, tmp_path, capsys, arguments, complaint):
    """A mistyped time or size would be drawn as another one."""
    file = tmp_path / 'cloth.png'
    with pytest.raises(SystemExit) as stop:
        main(['render', str(run / 'small'), '--out', str(file), *arguments])
    assert stop.value.code == 2
    assert complaint in capsys.readouterr().err
    assert not file.exists()


@pytest.mark.parametrize(('arguments', 'complaint'), [
    (['none', '--out', 'x.png'], 'there is no recording none'),
    (['none.npz', '--out', 'x.png'], 'there is no state file none.npz'),
    (['none'], 'there is nothing to write'),
    (['none', '--out', 'x.png', '--labels', 'a', 'b'], '2 names for 1 recordings'),
    (['none', '--out', 'x.png', '--columns', '0'], '--columns must be 1 or more'),
    (['none', '--out', 'x.png', '--zoom', '0'], 'zoom must be above 0'),
])
def test_says_what_is_wrong(tmp_path, monkeypatch, capsys, arguments, complaint):
    """A wrong path would end in a traceback."""
    monkeypatch.chdir(tmp_path)
    assert main(['render', *arguments]) == 1
    assert complaint in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
