# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Asking what a recording holds."""

from pathlib import Path
import shutil

from cloth_sim_ros.verb.main import main
import pytest

ROOT = Path(__file__).resolve().parents[2]


def test_tells_what_was_recorded(tmp_path, capsys):
    """A user would need another tool to see what a recording is of."""
    assert main([
        'run', str(ROOT / 'config' / 'curtain.yaml'), '--seconds', '0.7', '--record',
        str(tmp_path), '--set', 'rows=8', '--set', 'cols=46', '--set',
        'recording.name=small']) == 0
    capsys.readouterr()
    assert main(['info', str(tmp_path / 'small')]) == 0
    lines = dict(line.split(None, 1) for line in capsys.readouterr().out.splitlines())
    assert lines['cloth'] == '8 x 46 nodes'
    assert lines['mode'] == 'mass_spring'
    assert lines['time'] == '0 to 0.7 s, 36 frames'
    assert lines['inputs'].startswith('pushes: 2, nodes released: 0')
    assert lines['state'] == 'finite'


@pytest.fixture(scope='module')
def recorded(tmp_path_factory) -> Path:
    """Return the file of a recording of one chunk."""
    folder = tmp_path_factory.mktemp('bags')
    assert main([
        'run', str(ROOT / 'config' / 'curtain.yaml'), '--seconds', '0.2', '--record', str(folder),
        '--set', 'rows=8', '--set', 'cols=46', '--set', 'recording.name=small']) == 0
    return folder / 'small' / 'small_0.mcap'


@pytest.mark.parametrize('arguments', [('info',), ('info', '--node', 'cloth_sim'), (
    'render', '--out', 'picture.png'), ('analyze',), ('resimulate',), ('play', '--delay', '0'), (
        'export', '--format', 'obj')])
@pytest.mark.parametrize('length', [0, 5, 8, 42, 538, 3000, 20000])
def test_a_recording_cut_off_in_its_first_chunk_is_told_so(
        recorded, tmp_path, monkeypatch, capsys, length, arguments):
    """A user would be advised to record points, which were being recorded."""
    monkeypatch.chdir(tmp_path)
    content = recorded.read_bytes()
    assert len(content) > 20000
    (tmp_path / 'cut.mcap').write_bytes(content[:length])
    capsys.readouterr()
    assert main([arguments[0], 'cut.mcap', *arguments[1:]]) == 1
    said = capsys.readouterr().err
    assert 'its writer was killed before the first flush' in said
    assert 'publish.points' not in said and 'Traceback' not in said


@pytest.mark.parametrize(
    'verb', ['info', 'analyze', 'render', 'resimulate', 'play', 'recover', 'export'])
@pytest.mark.parametrize('left', [(), ('metadata.yaml.new',), ('small_0.mcap',)])
def test_empty_recording_folder_is_named_as_such(
        tmp_path, monkeypatch, capsys, left, verb):
    """The folder of a run killed at its start would be attributed to another program."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'small').mkdir()
    for name in left:
        (tmp_path / 'small' / name).touch()
    arguments = {
        'render': ('--out', 'picture.png'), 'export': ('--format', 'obj')}.get(verb, ())
    assert main([verb, 'small', *arguments]) == 1
    assert 'its writer was killed before the first flush' in capsys.readouterr().err


@pytest.mark.parametrize('how', ['removed', 'emptied'])
def test_what_was_removed_later_is_not_called_a_kill(recorded, tmp_path, capsys, how):
    """A user whose file was removed after minutes would look for a crash in the first second."""
    folder = tmp_path / 'lost'
    shutil.copytree(recorded.parent, folder)
    file = folder / recorded.name
    if how == 'removed':
        file.unlink()
    else:
        file.write_bytes(b'')
    assert main(['info', str(folder)]) == 1
    said = capsys.readouterr().err
    assert 'or messages were cut off or removed since' in said and 'within a second' not in said


def test_says_what_is_wrong_with_a_recording(tmp_path, capsys):
    """A wrong path would end in a traceback."""
    assert main(['info', str(tmp_path / 'none')]) == 1
    assert 'there is no recording' in capsys.readouterr().err
