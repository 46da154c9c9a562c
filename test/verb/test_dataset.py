# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""`cloth_sim dataset` makes labelled pictures, the same ones again, and goes on where it was."""

import json
from pathlib import Path
import shutil

from cloth_sim_ros.verb.main import main
import numpy as np
from PIL import Image
import pytest
import yaml

SCENE = {
    'rows': 10, 'cols': 10, 'width': 0.4, 'height': 0.4, 'pins': ['none'], 'start.z': 0.25,
    'colliders.names': ['table', 'ball'], 'colliders.table.shape': 'plane',
    'colliders.ball.size': [0.08], 'colliders.ball.position': [0.0, 0.0, 0.08],
    'cameras.names': ['eye'], 'cameras.eye.position': [0.5, 0.0, 0.5],
    'cameras.eye.target': [0.0, 0.0, 0.0], 'cameras.eye.width': 96, 'cameras.eye.height': 72}
SHORT = ['--seconds', '0.1', '0.3', '--lift', '0.2', '0.4', '--jobs', '1']


@pytest.fixture(scope='module')
def scene(tmp_path_factory) -> str:
    """Return the path of a scene file."""
    path = tmp_path_factory.mktemp('scene') / 'scene.yaml'
    path.write_text(yaml.safe_dump({'/**': {'ros__parameters': SCENE}}))
    return str(path)


@pytest.fixture(scope='module')
def made(scene, tmp_path_factory) -> Path:
    """Return a data set of three samples, made in one go."""
    folder = tmp_path_factory.mktemp('whole') / 'set'
    assert main(['dataset', scene, '--count', '3', '--seed', '5', *SHORT, '--out',
                 str(folder)]) == 0
    return folder


def test_files_agree_with_one_another(made):
    """A mask would be of another picture, or depth of another unit than it says."""
    said = json.loads((made / 'annotations.json').read_text())
    assert [image['id'] for image in said['images']] == [0, 1, 2]
    assert [each['name'] for each in said['categories']] == ['cloth', 'table', 'ball']
    assert len({entry['id'] for entry in said['annotations']}) == len(said['annotations'])
    for image in said['images']:
        number = image['id']
        color = np.asarray(Image.open(made / image['file_name']))
        labels = np.asarray(Image.open(made / 'labels' / f'{number:06d}.png'))
        depth = np.asarray(Image.open(made / 'depth' / f'{number:06d}.png'))
        sample = json.loads((made / 'samples' / f'{number:06d}.json').read_text())
        assert color.shape == (72, 96, 3) and depth.shape == labels.shape == (72, 96)
        assert depth.dtype == np.uint16
        np.testing.assert_array_equal(depth == 0, labels == 0)
        masks = {entry['category_id']: entry for entry in said['annotations']
                 if entry['image_id'] == number}
        assert {number: entry['area'] for number, entry in masks.items()} == {
            label: int((labels == label).sum()) for label in (1, 2, 3) if (labels == label).any()}
        # Nodes that are seen lie where the depth picture has the cloth, to some pixels.
        nodes = np.load(made / 'nodes' / f'{number:06d}.npz')
        assert nodes['positions'].shape == (10, 10, 3) and nodes['visible'].any()
        k = np.array(sample['k']).reshape(3, 3)
        x, y, z, w = sample['camera_orientation']
        turn = np.array([
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
        seen = (nodes['positions'][nodes['visible']] - sample['camera_position']) @ turn
        u, v = np.rint((seen / seen[:, 2:]) @ k.T)[:, :2].astype(int).T
        near = np.array([
            np.abs(depth[max(b - 1, 0):b + 2, max(a - 1, 0):a + 2] * sample['depth_unit']
                   - far).min() for a, b, far in zip(u, v, seen[:, 2])])
        # The pixels around one on an outline may all see what is behind it.
        assert np.median(near) < 0.005 and np.percentile(near, 90.0) < 0.02


def test_samples_differ(made):
    """A detector would see the same picture again and again."""
    samples = [json.loads(path.read_text()) for path in sorted((made / 'samples').iterdir())]
    for name in ('camera_position', 'look', 'annotations'):
        assert len({json.dumps(sample[name]) for sample in samples}) == 3, name


def test_a_set_that_was_stopped_goes_on(scene, made, tmp_path, capsys):
    """Hours of a large set would be lost, or its samples depend on how it was made."""
    again = ['dataset', scene, '--seed', '5', *SHORT, '--out', str(tmp_path / 'set')]
    assert main([*again, '--count', '1']) == 0
    first = (tmp_path / 'set' / 'samples' / '000000.json').stat().st_mtime_ns
    assert main([*again, '--count', '3']) == 0
    assert (tmp_path / 'set' / 'samples' / '000000.json').stat().st_mtime_ns == first
    assert '3 samples in' in capsys.readouterr().out
    for path in made.rglob('*'):
        if path.is_file() and path.suffix != '.npz':
            assert path.read_bytes() == (
                tmp_path / 'set' / path.relative_to(made)).read_bytes(), path
    for path in (made / 'nodes').iterdir():
        one, other = np.load(path), np.load(tmp_path / 'set' / 'nodes' / path.name)
        assert all((one[name] == other[name]).all() for name in one)


def test_a_sheet_shows_the_samples(scene, made, tmp_path, capsys):
    """Nobody would see what a set of thousands of files looks like."""
    again = ['dataset', scene, '--count', '3', '--seed', '5', *SHORT, '--out', str(made)]
    assert main([*again, '--sheet', str(tmp_path / 'sheet.png')]) == 0
    sheet = np.asarray(Image.open(tmp_path / 'sheet.png'))
    assert sheet.shape == (135, 3 * 544 - 4, 3)
    small = Image.open(made / 'images' / '000001.png').resize((180, 135), Image.LANCZOS)
    np.testing.assert_array_equal(sheet[:, 544:724], np.asarray(small))
    capsys.readouterr()
    assert main([*again, '--sheet', str(tmp_path / 'no' / 'sheet.png')]) != 0
    assert 'cannot be written' in capsys.readouterr().err


@pytest.mark.parametrize('wrong, rule', [
    (['--count', '0'], '--count must be from 1'),
    (['--count', '1', '--seconds', '2', '1'], '--seconds 2 1 must be two values from 0 to 1000'),
    (['--count', '1', '--elevation', '0', '90'], '--elevation 0 90 must be two values'),
    (['--count', '1', '--seed', '6'], 'has a data set with other values of seed'),
    (['--count', '1', '--set', 'rows=0'], 'rows 0 is outside its range'),
    (['--count', '1', '--set', 'cameras.eye.intrinsics=[0.0, 9.0, 4.0, 3.0]'], 'has fx 0: give'),
    (['--count', '1', '--set', 'cameras.eye.rate=1e9'], 'from 0.001 to 1000 Hz'),
    (['--count', '1', '--set', 'cameras.eye.width=1000000'], 'from 1 to 4096 pixel'),
    (['--count', '1', '--set', 'look.texture=no.png'], 'look.texture: there is no file no.png'),
])
def test_wrong_values_are_refused(scene, made, wrong, rule, capsys):
    """A set would be mixed with another, or fail in each of its samples."""
    before = sorted(made.rglob('*'))
    assert main(['dataset', scene, '--seed', '5', *SHORT, '--out', str(made), *wrong]) != 0
    said = capsys.readouterr().err.strip()
    assert rule in said and '\n' not in said
    assert sorted(made.rglob('*')) == before


@pytest.mark.parametrize('content', ['', '[1', '[]', '{"label_names": 3}', '[' * 10**5])
def test_a_damaged_sample_is_named(scene, made, tmp_path, content, capsys):
    """A sample cut off by a full disk ended each further run with a traceback."""
    folder = tmp_path / 'set'
    shutil.copytree(made, folder)
    sample = folder / 'samples' / '000001.json'
    sample.write_text(content)
    again = ['dataset', scene, '--count', '3', '--seed', '5', *SHORT, '--out', str(folder)]
    assert main(again) != 0
    said = capsys.readouterr().err.strip()
    assert said.endswith('which makes that sample anew') and said.count('\n') == 0, said
    sample.unlink()
    assert main(again) == 0
    assert sample.read_bytes() == (made / 'samples' / '000001.json').read_bytes()
