# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Files made to do harm: each verb refuses them in a sentence, soon and in little memory."""

import os
from pathlib import Path
import shutil
import sqlite3

from cloth_sim_ros.recording.bag_reader import BagReader
from copied_bag import copy_bag
from hostile_mcap import CHUNKS
from hostile_mcap import DEFINITIONS
from hostile_mcap import write_chunk
from hostile_mcap import write_definition
import pytest

CONFIG = Path(__file__).resolve().parents[2] / 'config'
SECONDS = 10.0
MEMORY = 1 << 30  # [bytes]
DEEP = 100_000


@pytest.fixture(scope='module')
def bag(tmp_path_factory, verbs):
    """Return a recording of a small cloth."""
    folder = tmp_path_factory.mktemp('recorded')
    outcome = verbs.run(
        'run', CONFIG / 'drape.yaml', '--set', 'rows=4', '--set', 'cols=5', '--seconds', 0.06,
        '--record', folder)
    assert outcome.code == 0, outcome
    found, = folder.iterdir()
    verbs.warm_up('info', found)
    return found


def check(outcome, code=None):
    """Fail unless a verb ended in time, by itself, with a line where it refused."""
    assert outcome.code in (0, 1) and code in (None, outcome.code), outcome
    assert 'Traceback' not in outcome.err + outcome.out, outcome
    assert outcome.seconds <= SECONDS and outcome.memory <= MEMORY, outcome
    lines = outcome.err.strip().splitlines()
    assert all(line.startswith('cloth_sim ') and len(line) < 2500 for line in lines), outcome
    # The player names each topic that it leaves out.
    assert not outcome.code or sum(' is left out: ' not in line for line in lines) == 1, outcome


def bomb():
    """Return ten-fold aliases, ten deep."""
    lines = ['a0: &a0 [x, x, x, x, x, x, x, x, x, x]']
    for number in range(1, 11):
        repeated = ', '.join([f'*a{number - 1}'] * 10)
        lines.append(f'a{number}: &a{number} [{repeated}]')
    return '\n'.join(lines) + '\n'


VALUES = (
    '2001-99-99', '2001-01-01', '0x_', '!!int "abc"', '!!bool "abc"', '!!float "abc"',
    '!!timestamp x', '!!timestamp 2001-99-99', '!!binary "?"', '!!set [1]', '!!omap {a: 1}',
    '!!pairs [1]', '!!python/name:os.system', '9' * 5000, '0x' + 'f' * 5000, '0b', '1e99999',
    '&b {x: *b}', '&b [*b]', '*b', '{[1]: 2}', '{{a: 1}: 2}', '=', '<<', '{<<: 3}',
    '[' * 1000, '[' * DEEP, '{a: ' * DEEP, '- ' * DEEP, '"\\ud800"', '!!null "x"', '190:20:30.15',
    '!<tag:yaml.org,2002:int> 0x_', '&' + 'a' * 5000 + ' x', 'x' * 1_000_000)
SCENES = {
    **{f'dt {value[:24]}': f'/**: {{ros__parameters: {{dt: {value}}}}}' for value in VALUES},
    **{f'alone {value[:24]}': value for value in VALUES},
    'aliases': bomb(), 'key twice': '/**: {ros__parameters: {dt: 0.01, dt: 0.02}}',
    'aliases in a section': bomb() + '/**: {ros__parameters: {pins: *a10}}',
    'many keys': '/**: {ros__parameters: {' + ', '.join(f'a{i}: 1' for i in range(50_000)) + '}}',
    'a long list': '/**: {ros__parameters: {pins: [' + 'x, ' * 500_000 + ']}}',
}


@pytest.mark.parametrize('name', SCENES)
def test_a_hostile_scene_is_refused(verbs, tmp_path, name):
    """A scene from elsewhere would end `cloth_sim run` as a traceback, by a signal, or never."""
    file = tmp_path / 'scene.yaml'
    file.write_text(SCENES[name])
    check(verbs.run('run', file), 1)
    if len(SCENES[name]) < 100_000:  # an argument can't be longer
        check(verbs.run('run', CONFIG / 'drape.yaml', '--set', f'dt={SCENES[name]}'), 1)


@pytest.mark.parametrize('kind', ['pipe', '/dev/zero', '/dev/urandom', 'large', 'long name'])
def test_a_scene_that_is_no_file_is_refused(verbs, tmp_path, kind):
    """`cloth_sim run` would wait for ever, or read until the memory is full."""
    path = Path(kind) if kind.startswith('/') else tmp_path / 'scene.yaml'
    if kind == 'pipe':
        os.mkfifo(path)
    elif kind == 'large':
        path.write_bytes(b'a: [' + b'1, ' * 35_000_000 + b']')
    elif kind == 'long name':
        path = tmp_path / ('x' * 5000)
    check(verbs.run('run', path), 1)
    check(verbs.run('render', f'{path}.npz' if kind == 'long name' else path, '--out', 'x.png'), 1)
    check(verbs.run('info', path), 1)
    check(verbs.run('export', path, '--output', tmp_path / 'x.obj'), 1)


def names(*listed):
    """Return a metadata.yaml that lists these files."""
    quoted = ', '.join(f'"{name}"' for name in listed)
    return f'rosbag2_bagfile_information: {{relative_file_paths: [{quoted}]}}\n'


METADATA = {
    'brackets': '[' * DEEP, 'braces': '{a: ' * DEEP,
    'brackets as the mode': f'rosbag2_bagfile_information: {{compression_mode: {"[" * DEEP}',
    'aliases': bomb() + 'rosbag2_bagfile_information: {compression_mode: *a10}\n',
    'aliases as names': bomb() + 'rosbag2_bagfile_information: {relative_file_paths: *a10}\n',
    'a long name': names('x' * 5000 + '.mcap'), 'no name': names('a\\0b.mcap', '', '..', '/'),
    'compressed in another way':
        'rosbag2_bagfile_information: {compression_mode: file, compression_format: *a}',
    'compressed': 'rosbag2_bagfile_information: {compression_mode: FILE, compression_format: zstd,'
                  ' relative_file_paths: [metadata.yaml]}',
    'compressed device': 'rosbag2_bagfile_information: {compression_mode: FILE, '
                         'compression_format: zstd, relative_file_paths: [zero]}',
    'pipe': None,
}


@pytest.mark.parametrize('name', METADATA)
def test_hostile_metadata_does_no_harm(verbs, bag, tmp_path, name):
    """A recording from elsewhere would end every verb by a signal, or keep it for ever."""
    folder = shutil.copytree(bag, tmp_path / 'bag')
    (folder / 'metadata.yaml').unlink()
    (folder / 'zero').symlink_to('/dev/zero')
    if METADATA[name] is None:
        os.mkfifo(folder / 'metadata.yaml')
    else:
        (folder / 'metadata.yaml').write_text(METADATA[name])
    for verb in ('info', 'analyze'):
        check(verbs.run(verb, folder))
    if name in ('brackets', 'aliases', 'pipe'):
        check(verbs.run('resimulate', folder), 0)


def test_a_file_listed_often_is_read_once(bag, tmp_path):
    """A line of text would multiply the run, and the time to read it."""
    folder = shutil.copytree(bag, tmp_path / 'bag')
    file, = folder.glob('*.mcap')
    (folder / 'metadata.yaml').write_text(names(*[file.name] * 200))
    assert len(list(BagReader(folder).messages())) == len(list(BagReader(file).messages()))


@pytest.mark.parametrize('name', CHUNKS)
@pytest.mark.parametrize('has_index', [True, False], ids=['whole', 'cut'])
def test_a_hostile_chunk_does_no_harm(verbs, tmp_path, name, has_index):
    """A few bytes would be unpacked until the memory is full."""
    write_chunk(tmp_path / 'bag.mcap', name, has_index)
    check(verbs.run('info', tmp_path / 'bag.mcap'), 1)


@pytest.mark.parametrize('name', DEFINITIONS)
def test_a_hostile_definition_does_no_harm(verbs, tmp_path, name):
    """A message type of a few bytes would keep every verb for ever."""
    write_definition(tmp_path / 'bag.mcap', name)
    check(verbs.run('info', tmp_path / 'bag.mcap'), 1)


TABLES = {
    'a view': 'DROP TABLE messages; CREATE VIEW messages AS WITH RECURSIVE n(x) AS (SELECT 1 '
              'UNION ALL SELECT x + 1 FROM n) SELECT x AS id, 1 AS topic_id, x AS timestamp, '
              'zeroblob(1000000000) AS data FROM n',
    'a computed column': 'ALTER TABLE messages RENAME TO old; CREATE TABLE messages(id INTEGER '
                         'PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB AS '
                         '(zeroblob(900000000))); INSERT INTO messages(topic_id, timestamp) '
                         'SELECT topic_id, timestamp FROM old',
    'a virtual table': 'DROP TABLE messages; CREATE VIRTUAL TABLE messages USING '
                       'fts4(topic_id, timestamp, data)',
    'words as times': "UPDATE messages SET timestamp = 'x'", 'no times':
        'ALTER TABLE messages RENAME TO old; CREATE TABLE messages(id, topic_id, timestamp, data);'
        'INSERT INTO messages SELECT id, topic_id, NULL, data FROM old',
    'words as data': "UPDATE messages SET data = 'x'", 'numbers as data':
        'UPDATE messages SET data = 3',
    'numbers as names': 'UPDATE topics SET name = 3', 'bytes as types':
        "UPDATE topics SET type = x'ff00'",
    'words as numbers': 'PRAGMA writable_schema = ON; UPDATE sqlite_master SET sql = '
                        "replace(sql, 'id INTEGER PRIMARY KEY', 'id TEXT') WHERE name = 'topics'",
    'deep profiles': f"UPDATE topics SET offered_qos_profiles = '{'[' * DEEP}'",
    'strange profiles': "UPDATE topics SET offered_qos_profiles = '- {depth: [1]}'",
    'other definitions': "UPDATE message_definitions SET encoding = 'x'",
    'numbers as definitions': 'UPDATE message_definitions SET encoded_message_definition = 3',
    'no columns': 'DROP TABLE topics; CREATE TABLE topics(x)',
    'extreme times': 'UPDATE messages SET timestamp = 9223372036854775807',
}


@pytest.mark.parametrize('name', TABLES)
def test_a_hostile_database_does_no_harm(verbs, bag, tmp_path, name):
    """A database is a program: it would compute until the memory is full."""
    folder = copy_bag(bag, tmp_path / 'bag', 'sqlite3')
    file, = folder.glob('*.db3')
    with sqlite3.connect(file) as database:
        database.executescript(TABLES[name])
    database.close()
    for verb in ('info', 'analyze'):
        check(verbs.run(verb, folder))
    check(verbs.run('play', folder, '--delay', 0, '--rate', 1e6, '--duration', 1))


@pytest.mark.parametrize('kind', [
    'pipe', '/dev/zero', '/dev/urandom', 'large', 'long name', 'wide', 'PostScript', 'text'])
def test_a_mask_that_is_no_image_is_refused(verbs, tmp_path, kind):
    """A run would wait for ever, fill the memory, or run what an image tells it to."""
    file = Path(kind) if kind.startswith('/dev') else tmp_path / 'mask.png'
    if kind == 'pipe':
        os.mkfifo(file)
    elif kind == 'large':
        with file.open('wb') as stream:
            stream.truncate(1 << 40)
    elif kind == 'long name':
        file = tmp_path / ('x' * 5000)
    elif kind == 'wide':
        # 40,000 x 25,000 pixels in its head.
        file.write_bytes(bytes.fromhex(
            '89504e470d0a1a0a0000000d49484452' '00009c40000061a80800000000'
            '88c5a9d5') + bytes(4) + b'IDAT' + bytes.fromhex('35af061e'))
    elif kind == 'PostScript':
        file.write_text('%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 4 4\n(x) run\n')
    elif kind == 'text':
        file.write_text('no image')
    check(verbs.run(
        'run', CONFIG / 'drape.yaml', '--set', f'shape.mask={file}', '--set', 'rows=9', '--set',
        'cols=9', '--seconds', 0.02), 1)
