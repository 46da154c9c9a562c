# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Recordings that were cut off or damaged, made whole for other tools."""

import random
import shutil

from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.recording.recovery import Recovery
from cloth_sim_ros.sim.errors import ClothSimError
from copied_bag import copy_bag
from mcap.reader import make_reader
import pytest
from rosbags.highlevel import AnyReader
import yaml

SEED = 20261122


def contents(path):
    """Return time, topic, type and data of all messages, as rosbags reads them."""
    with AnyReader([path]) as reader:
        return [
            (time, connection.topic, connection.msgtype, bytes(data))
            for connection, time, data in reader.messages()]


@pytest.fixture
def cut(recorded, tmp_path):
    """Return a copy of the recording without its last 40 %, as it stands when one is killed."""
    folder = shutil.copytree(recorded, tmp_path / 'run')
    file = folder / 'run_0.mcap'
    file.write_bytes(file.read_bytes()[:int(0.6 * file.stat().st_size)])
    return folder


def test_other_tools_read_what_was_whole(cut, recorded, tmp_path):
    """The recording of a killed run could be read by this project alone."""
    with pytest.raises(Exception):
        contents(cut)
    before = (cut / 'run_0.mcap').read_bytes()
    recovery = Recovery(cut)
    assert 'run_0.mcap lacks everything after its first ' in recovery.problems[0]
    recovery.write(tmp_path / 'whole', '--out')
    found = contents(tmp_path / 'whole')
    assert found == contents(recorded)[:len(found)]
    assert len(found) == recovery.message_count == sum(1 for _ in BagReader(cut).messages())
    assert recovery.end == found[-1][0]
    assert BagReader(tmp_path / 'whole').problems == []
    assert (cut / 'run_0.mcap').read_bytes() == before


def test_the_new_bag_says_what_the_old_one_said(cut, recorded, tmp_path):
    """A player would offer other qualities of service, or not know the version of the run."""
    Recovery(cut).write(tmp_path / 'whole', '--out')
    told = []
    for path in (recorded / 'run_0.mcap', tmp_path / 'whole' / 'whole_0.mcap'):
        with open(path, 'rb') as stream:
            summary = make_reader(stream).get_summary()
        schemas = {schema.id: schema for schema in summary.schemas.values()}
        told.append(sorted(
            (channel.topic, channel.metadata['offered_qos_profiles'],
             channel.metadata['topic_type_hash'], schemas[channel.schema_id].name,
             schemas[channel.schema_id].data) for channel in summary.channels.values()))
    assert told[0] == told[1]
    old, new = (
        yaml.safe_load((folder / 'metadata.yaml').read_text())['rosbag2_bagfile_information']
        for folder in (recorded, tmp_path / 'whole'))
    assert new['custom_data'] == old['custom_data']
    assert [topic['topic_metadata'] for topic in new['topics_with_message_count']] == [
        topic['topic_metadata'] for topic in old['topics_with_message_count']]
    assert new['relative_file_paths'] == ['whole_0.mcap']


def test_cut_anywhere_all_whole_messages_are_kept(recorded, tmp_path):
    """Messages would be lost that are there, or bytes be taken for messages that are none."""
    whole = contents(recorded)
    content = (recorded / 'run_0.mcap').read_bytes()
    generator = random.Random(SEED)
    file = tmp_path / 'cut.mcap'
    for number, size in enumerate(generator.randrange(len(content)) for _ in range(12)):
        file.write_bytes(content[:size])
        expected = read_or_none(file)
        if not expected:
            with pytest.raises(ClothSimError, match='killed before the first flush'):
                Recovery(file)
            continue
        Recovery(file).write(tmp_path / f'whole_{number}', '--out')
        assert contents(tmp_path / f'whole_{number}') == whole[:expected], (SEED, size)


def read_or_none(file):
    """Return how many messages can be read of a file that is cut; 0 for one without any."""
    try:
        return sum(1 for _ in BagReader(file).messages())
    except ClothSimError:
        return 0


@pytest.mark.parametrize('place', [0.2, 0.5, 0.8])
def test_what_comes_after_a_damaged_byte_is_kept(recorded, tmp_path, place):
    """A worn disk would take all that was recorded behind the byte."""
    folder = shutil.copytree(recorded, tmp_path / 'run')
    content = bytearray((folder / 'run_0.mcap').read_bytes())
    content[int(place * len(content))] ^= 0xff
    (folder / 'run_0.mcap').write_bytes(content)
    recovery = Recovery(folder)
    assert 'run_0.mcap lacks the contents of 1 damaged records' in recovery.problems
    recovery.write(tmp_path / 'whole', '--out')
    whole, found = contents(recorded), contents(tmp_path / 'whole')
    assert set(found) < set(whole) and found[-1] == whole[-1]


def test_a_whole_recording_lacks_nothing(recorded):
    """A user would double a recording for nothing."""
    recovery = Recovery(recorded)
    assert recovery.problems == []
    assert recovery.message_count == len(contents(recorded))


@pytest.mark.parametrize('damage', ['', 'rosbag2_bagfile_information:\n  version: [9'])
def test_metadata_alone_is_made_again(recorded, tmp_path, damage):
    """`ros2 bag` would refuse a recording with all of its messages."""
    folder = shutil.copytree(recorded, tmp_path / 'run')
    (folder / 'metadata.yaml').write_text(damage)
    recovery = Recovery(folder)
    assert recovery.problems == ['metadata.yaml is missing or damaged']
    recovery.write(tmp_path / 'whole', '--out')
    assert contents(tmp_path / 'whole') == contents(recorded)


def test_a_split_recording_keeps_its_files(recorded, tmp_path):
    """The file that was cut would take the others with it, or be left out."""
    folder = copy_bag(recorded, tmp_path / 'run', split=3)
    last = folder / 'run_2.mcap'
    last.write_bytes(last.read_bytes()[:-100])
    recovery = Recovery(folder)
    assert any(problem.startswith('run_2.mcap lacks ') for problem in recovery.problems)
    recovery.write(tmp_path / 'whole', '--out')
    assert sorted(path.name for path in (tmp_path / 'whole').iterdir()) == [
        'metadata.yaml', 'whole_0.mcap', 'whole_1.mcap', 'whole_2.mcap']
    found = [entry[1:] for entry in contents(tmp_path / 'whole')]
    assert found == [entry[1:] for entry in contents(recorded)][:len(found)]
    assert len(found) == recovery.message_count
    last.write_bytes(b'')
    recovery = Recovery(folder)
    recovery.write(tmp_path / 'without', '--out')
    assert len(list((tmp_path / 'without').glob('*.mcap'))) == 2


def test_nothing_is_overwritten(cut, tmp_path):
    """A recording that is there would be lost for one that is broken."""
    (tmp_path / 'there').mkdir()
    with pytest.raises(ClothSimError, match='already exists'):
        Recovery(cut).write(tmp_path / 'there', '--out')
    assert list((tmp_path / 'there').iterdir()) == []


def test_what_cannot_be_recovered_is_refused(recorded, tmp_path):
    """A traceback would be shown, or a bag without messages be written."""
    database = copy_bag(recorded, tmp_path / 'database', 'sqlite3')
    with pytest.raises(ClothSimError, match=r'only mcap files can be recovered: .*\.recover'):
        Recovery(database)
    compressed = copy_bag(recorded, tmp_path / 'compressed', compression='FILE')
    with pytest.raises(ClothSimError, match='decompress its files first'):
        Recovery(compressed)
    with pytest.raises(ClothSimError, match='there is no recording'):
        Recovery(tmp_path / 'none')
