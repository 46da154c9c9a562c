# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Files damaged at random, read by every verb that reads such a file."""

from pathlib import Path
from random import Random
import shutil

from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from copied_bag import copy_bag
from forked_verbs import Outcome
from mcap.writer import CompressionType
from mcap.writer import Writer
from mutations import mutate_bytes
from mutations import mutate_text
import numpy as np
from PIL import Image
import pytest

CONFIG = Path(__file__).resolve().parents[2] / 'config'
COUNTS = pytest.mark.parametrize('count', [12, pytest.param(1000, marks=pytest.mark.long)])
SECONDS = 10.0
MEMORY = 1 << 30  # [bytes]
# A scene of a few nodes and steps: with damage that has no effect, the run takes little time.
SMALL = (
    '--set', 'rows=4', '--set', 'cols=5', '--set', 'pushes.start=[0.02]', '--set',
    'pushes.duration=[0.02]', '--set', 'pushes.force=[0.0, 0.0, 0.5]', '--set',
    'pushes.center=[]', '--set', 'pushes.radius=[]')


@pytest.fixture(scope='module')
def base(tmp_path_factory, verbs):
    """Return a folder with a recording, the same as sqlite3 and without checksums, and a state."""
    folder = tmp_path_factory.mktemp('base')
    outcome = verbs.run(
        'run', CONFIG / 'drape.yaml', *SMALL, '--seconds', 0.06, '--record', folder,
        '--out', folder / 'state.npz')
    assert outcome.code == 0, outcome
    bag, = (path for path in folder.iterdir() if path.is_dir())
    bag.rename(folder / 'bag')
    copy_bag(folder / 'bag', folder / 'sqlite3', 'sqlite3')
    (folder / 'open').mkdir()
    write_open(BagReader(folder / 'bag'), folder / 'open' / 'open.mcap')
    verbs.warm_up('info', folder / 'bag')
    return folder


def write_open(reader: BagReader, path: Path) -> None:
    """Write a recording so that every byte of it is read as it stands."""
    with path.open('wb') as stream:
        writer = Writer(
            stream, compression=CompressionType.NONE, enable_crcs=False, chunk_size=20_000)
        writer.start(profile='ros2')
        channels = {}
        for topic in reader.topics:
            schema = writer.register_schema(
                topic.type_name, 'ros2msg', topic.definition.data.encode())
            channels[topic.name] = writer.register_channel(topic.name, 'cdr', schema)
        for message in reader.messages():
            writer.add_message(channels[message.topic], message.time, message.data, message.time)
        writer.finish()


def check(outcome: Outcome, told: str) -> None:
    """Fail unless a verb has worked, or refused in a line."""
    told = f'{told}: {outcome}'
    assert outcome.code in (0, 1, 2), told
    assert 'Traceback' not in outcome.err + outcome.out, told
    assert outcome.seconds <= SECONDS and outcome.memory <= MEMORY, told
    lines = outcome.err.strip().splitlines()
    assert outcome.code != 1 or sum(' is left out: ' not in line for line in lines) <= 1, told


def read_bag(verbs, bag, out, number):
    """Return the outcome of a verb that reads ``bag``: info mostly, which is quick."""
    if number % 20 == 3:
        return verbs.run('render', bag, '--out', out / 'picture.png', '--size', '64x64')
    if number % 20 == 9:
        ending = ('glb', 'usda')[number % 40 > 20]
        return verbs.run('export', bag, '--output', out / f'mesh.{ending}')
    if number % 10 == 7:
        return verbs.run('resimulate', bag)
    if number % 50 == 11:
        return verbs.run('analyze', bag, '--out', out / 'analysis')
    if number % 50 == 13:
        return verbs.run(
            'play', bag, '--delay', 0, '--rate', 1e6, '--duration', 1)
    return verbs.run(('info', 'analyze')[number % 2], bag)


def try_bags(verbs, seed, count, folder, make):
    """Read ``count`` bags that ``make`` damages; print how many of them could be read."""
    read = 0
    for number in range(count):
        random = Random(f'{seed} {number}')
        bag = make(folder / 'bag', random)
        outcome = read_bag(verbs, bag, folder, number)
        check(outcome, f'seed {seed}, number {number}')
        read += outcome.code == 0
        shutil.rmtree(folder)
        folder.mkdir()
    print(f'{read} of {count} could be read')


def with_damaged(source, suffix, mutate):
    """Return what makes a copy of a bag with its file of that ``suffix`` damaged."""
    def make(folder, random):
        shutil.copytree(source, folder)
        file, = folder.glob(f'*{suffix}')
        file.write_bytes(mutate(file.read_bytes(), random))
        return folder
    return make


def metadata_of(data, random):
    """Return a damaged metadata.yaml."""
    return mutate_text(data.decode(), random)


CASES = {
    'mcap': ('bag', '.mcap', mutate_bytes), 'open mcap': ('open', '.mcap', mutate_bytes),
    'sqlite3': ('sqlite3', '.db3', mutate_bytes), 'metadata': ('bag', '.yaml', metadata_of)}


@COUNTS
@pytest.mark.parametrize('kind', CASES)
def test_damaged_recordings_are_read_or_refused(base, verbs, tmp_path, usual_seed, kind, count):
    """A recording from elsewhere would end a verb as a traceback, or take the machine."""
    source, suffix, mutate = CASES[kind]
    (tmp_path / 'each').mkdir()
    try_bags(
        verbs, usual_seed, count, tmp_path / 'each', with_damaged(base / source, suffix, mutate))


@COUNTS
def test_damaged_states_are_drawn_or_refused(base, verbs, tmp_path, usual_seed, count):
    """A state from elsewhere would end `cloth_sim render` as a traceback."""
    content = (base / 'state.npz').read_bytes()
    packed = tmp_path / 'packed.npz'
    with np.load(base / 'state.npz') as arrays:
        np.savez_compressed(packed, **arrays)
    file = tmp_path / 'state.npz'
    drawn = 0
    for number in range(count):
        random = Random(f'{usual_seed} {number}')
        data = packed.read_bytes() if number % 2 else content
        file.write_bytes(mutate_bytes(data, random))
        outcome = verbs.run('render', file, '--out', tmp_path / 'state.png', '--size', '64x64')
        check(outcome, f'seed {usual_seed}, number {number}')
        drawn += outcome.code == 0
    print(f'{drawn} of {count} were drawn')


@COUNTS
def test_damaged_scenes_are_run_or_refused(verbs, tmp_path, usual_seed, count):
    """A slip of the keyboard would end `cloth_sim run` as a traceback."""
    texts = [path.read_text() for path in sorted(CONFIG.glob('*.yaml'))]
    file = tmp_path / 'scene.yaml'
    refused = 0
    for number in range(count):
        random = Random(f'{usual_seed} {number}')
        file.write_bytes(mutate_text(random.choice(texts), random))
        # For a time that is refused before a device is needed.
        words = ('run', file, '--set', 'rows=4', '--set', 'cols=4', '--seconds', 0.02)
        outcome = verbs.run(*words)
        if outcome.code == 0 and outcome.seconds > SECONDS:
            # The driver has compiled the shaders of that scene, and kept them.
            outcome = verbs.run(*words)
        check(outcome, f'seed {usual_seed}, number {number}')
        refused += outcome.code
    print(f'{refused} of {count} were refused')


@COUNTS
@pytest.mark.parametrize('ending', ['png', 'jpg', 'gif', 'tiff', 'webp', 'ppm'])
def test_damaged_masks_are_cut_or_refused(tmp_path, usual_seed, ending, count):
    """An image from elsewhere would end a run as a traceback."""
    grey = np.zeros((40, 40), np.uint8)
    grey[4:36, 5:33] = 255
    file = tmp_path / f'mask.{ending}'
    Image.fromarray(grey).save(file)
    content, cut = file.read_bytes(), 0
    for number in range(count):
        file.write_bytes(mutate_bytes(content, Random(f'{usual_seed} {number}')))
        try:
            Scene({'rows': 9, 'cols': 9, 'shape.mask': str(file), 'pins': ['none']})
            cut += 1
        except ClothSimError as error:
            assert '\n' not in str(error), f'seed {usual_seed}, number {number}'
    print(f'{cut} of {count} were cut')
