# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Reading any bag: how it was stored, and what is missing of it, must not matter."""

import random
import shutil

from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.sim.errors import ClothSimError
from copied_bag import copy_bag
from copied_bag import FACTOR
from copied_bag import WALL
from made_cloud import make_cloud
import pytest
from rosbags.interfaces import QosDurability
from rosbags.interfaces import QosReliability

FRAMES = 30


def contents(reader, names=None):
    """Return topic and decoded message of all messages, as far as it can be compared."""
    return [told(reader, raw) for raw in reader.messages(names)]


def told(reader, raw):
    """Return what a message says."""
    message = reader.decode(raw)
    if raw.topic.endswith('points'):
        return raw.topic, bytes(message.data)
    return raw.topic, getattr(message, 'steps', None), getattr(message, 'mode', None)


@pytest.fixture(scope='module')
def expected():
    """Return what the recording holds."""
    clouds = [make_cloud(64, 64, number)[1].tobytes() for number in range(FRAMES)]
    pairs = [
        [('/cloth_sim/points', cloud), ('/cloth_sim/stats', number, None)]
        for number, cloud in enumerate(clouds)]
    return [('/cloth_sim/inputs/mode', None, 'adaptive'), *sum(pairs, [])]


@pytest.fixture(params=[
    'recorder', 'mcap', 'sqlite3', 'split mcap', 'split sqlite3', 'mcap without metadata',
    'sqlite3 without metadata', 'mcap file', 'sqlite3 file', 'broken metadata', 'cut mcap'])
def bag(request, recorded, tmp_path):
    """Return one recording in each form it may come in."""
    kind = request.param
    if kind in ('recorder', 'cut mcap', 'broken metadata'):
        folder = shutil.copytree(recorded, tmp_path / 'bag')
        if kind == 'broken metadata':
            (folder / 'metadata.yaml').write_bytes(b'rosbag2_bagfile_information:\n  version: [9')
        if kind == 'cut mcap':
            cut_summary(folder)
        return folder
    storage = 'sqlite3' if 'sqlite3' in kind else 'mcap'
    folder = copy_bag(recorded, tmp_path / 'bag', storage, split=3 if 'split' in kind else 1)
    if 'without' in kind:
        (folder / 'metadata.yaml').unlink()
    if 'file' in kind:
        file, = (path for path in folder.iterdir() if path.suffix != '.yaml')
        return file
    return folder


def cut_summary(folder):
    """Take the end of the mcap file that holds its index."""
    file, = folder.glob('*.mcap')
    content = file.read_bytes()
    file.write_bytes(content[:-200])


def test_the_same_messages_come_from_every_form(bag, expected):
    """The same run would look different when another program recorded it."""
    assert contents(BagReader(bag)) == expected


def test_topics_are_told_with_what_a_player_needs(bag):
    """Played back, late subscribers would miss the mode, or get no message at all."""
    topics = {topic.name: topic for topic in BagReader(bag).topics}
    points = topics['/cloth_sim/points']
    assert points.type_name == 'sensor_msgs/msg/PointCloud2'
    assert points.count == FRAMES
    qos, = points.qos
    assert qos.depth == 10
    assert qos.reliability is QosReliability.RELIABLE
    assert qos.durability is QosDurability.VOLATILE
    assert topics['/cloth_sim/inputs/mode'].count == 1


def test_only_what_is_asked_for_is_read(bag):
    """Reading a few numbers would take as long as reading all points."""
    reader = BagReader(bag)
    assert {raw.topic for raw in reader.messages(['/cloth_sim/stats'])} == {'/cloth_sim/stats'}
    assert list(reader.messages(['/none'])) == []


def test_two_walks_do_not_disturb_each_other(bag, expected):
    """Comparing a recording with itself would mix it up."""
    reader = BagReader(bag)
    for (first, second), wanted in zip(
            zip(reader.messages(), reader.messages(), strict=True), expected, strict=True):
        assert told(reader, first) == told(reader, second) == wanted


def test_times_are_those_of_the_recording(recorded, tmp_path):
    """A player would keep another pace."""
    times = [raw.time for raw in BagReader(recorded).messages(['/cloth_sim/points'])]
    assert times == [number * 20_000_000 for number in range(FRAMES)]
    copied = copy_bag(recorded, tmp_path / 'bag', 'sqlite3')
    assert [raw.time for raw in BagReader(copied).messages(['/cloth_sim/points'])] == [
        WALL + FACTOR * time for time in times]


def test_whole_recordings_have_no_problem(recorded):
    """A good recording would be called broken."""
    reader = BagReader(recorded)
    assert contents(reader)
    assert reader.problems == []


def test_truncated_file_is_read_or_refused(recorded, tmp_path, expected):
    """The recording of a killed run would be lost, or read with messages it never held."""
    file, = recorded.glob('*.mcap')
    content = file.read_bytes()
    cut = tmp_path / 'cut.mcap'
    generator = random.Random(4)
    lengths = []
    for size in sorted(generator.randrange(len(content)) for _ in range(50)):
        cut.write_bytes(content[:size])
        try:
            reader = BagReader(cut)
        except ClothSimError as error:
            assert size < 8 and 'give' in str(error)
            continue
        read = contents(reader)
        assert read == expected[:len(read)]
        assert len(read) == sum(topic.count for topic in reader.topics)
        assert len(reader.problems) == 1 and 'is truncated' in reader.problems[0]
        lengths.append(len(read))
    assert lengths == sorted(lengths) and lengths[-1] > len(expected) / 2


@pytest.mark.parametrize('place', [0.2, 0.5, 0.8])
def test_a_damaged_byte_ends_the_reading_and_is_told(recorded, tmp_path, expected, place):
    """A worn disk would give wrong numbers, or a traceback."""
    folder = shutil.copytree(recorded, tmp_path / 'bag')
    file, = folder.glob('*.mcap')
    content = bytearray(file.read_bytes())
    content[int(place * len(content))] ^= 0xff
    file.write_bytes(content)
    reader = BagReader(folder)
    read = contents(reader)
    assert read == expected[:len(read)] and len(read) < len(expected)
    assert 'damaged' in reader.problems[0]


def test_a_cut_sqlite3_file_is_told_with_the_way_out(recorded, tmp_path):
    """A user would get the database's own words, and no way to save the run."""
    folder = copy_bag(recorded, tmp_path / 'bag', 'sqlite3')
    file, = folder.glob('*.db3')
    content = file.read_bytes()
    generator = random.Random(5)
    for size in sorted(generator.randrange(len(content)) for _ in range(20)):
        file.write_bytes(content[:size])
        with pytest.raises(ClothSimError, match=r'not an intact sqlite3 bag.*\.recover'):
            contents(BagReader(folder))


def test_split_recording_without_its_last_file(recorded, tmp_path, expected):
    """All of a long run would be lost with its last file."""
    folder = copy_bag(recorded, tmp_path / 'bag', split=3)
    last = folder / 'bag_2.mcap'
    last.write_bytes(last.read_bytes()[:-100])
    reader = BagReader(folder)
    assert contents(reader)[:40] == expected[:40]
    last.write_bytes(b'')
    reader = BagReader(folder)
    assert contents(reader) == expected[:-(-len(expected) // 3) * 2]
    assert 'bag_2.mcap is empty' in reader.problems[0]


@pytest.mark.parametrize('compression', ['FILE', 'MESSAGE'])
def test_compressed_bags_of_rosbag2_are_read(recorded, tmp_path, expected, compression):
    """A bag of `ros2 bag record --compression-mode` would be refused."""
    copy_bag(recorded, tmp_path / 'bag', 'sqlite3', compression=compression)
    assert contents(BagReader(tmp_path / 'bag')) == expected


@pytest.mark.parametrize('content, reason', [
    (b'', 'is empty: its writer was killed before .*; give'),
    (b'\x89MCAP', 'has 5 bytes: its writer was killed before .*; give'),
    (b'nothing of the kind', 'not an mcap file.*: give')])
def test_what_is_no_bag_is_refused(tmp_path, content, reason):
    """A wrong file would end in a traceback."""
    file = tmp_path / 'bag.mcap'
    file.write_bytes(content)
    with pytest.raises(ClothSimError, match=reason):
        BagReader(file)
