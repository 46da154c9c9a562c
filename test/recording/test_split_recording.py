# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Recordings of several files, and of limited size."""

import os
import shutil

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.messages.geometry import serialise_topology
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.recording.bag_folder import RecordingOptions
from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.recording.bag_writer import BagWriter
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.recording.recorder import topic_channel
from cloth_sim_ros.recording.recording_faults import RecordingFull
from cloth_sim_ros.sim.scene import Scene
from made_cloud import make_cloud
from mcap.reader import make_reader
import pytest
from rclpy.serialization import serialize_message
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader
from springs import SPRINGS
import yaml

FRAMES = 150
PERIOD = 0.02
SIDE = 48
MIB = 2**20


def record(folder, name='run', frames=FRAMES, **options):
    """Return the folder of a recording of clouds that don't compress, and what ended it."""
    recorder = Recorder(folder, name, options=RecordingOptions(**options))
    try:
        recorder.write(
            'topology', serialise_topology(Scene({**SPRINGS, 'rows': SIDE, 'cols': SIDE})), 0.0)
        recorder.write('state', serialize_message(ClothState(mode='adaptive')), 0.0)
        for number in range(frames):
            time = number * PERIOD
            recorder.write('stats', serialize_message(ClothStats(steps=number)), time)
            recorder.write('points', make_cloud(SIDE, SIDE, number)[0], time)
        recorder.close()
    except RecordingFull as full:
        return recorder.path, full
    return recorder.path, None


@pytest.fixture(scope='module', params=[
    {'max_bagfile_size': 2 * MIB}, {'max_bagfile_duration': 1.0},
    {'max_bagfile_size': 3 * MIB, 'max_bagfile_duration': 1.0, 'fsync': True}], ids=str)
def split(request, tmp_path_factory):
    """Return a recording of several files and its options."""
    path, full = record(tmp_path_factory.mktemp('split'), **request.param)
    assert full is None
    return path, request.param


def steps(paths):
    """Return the steps that the numbers in the bags ``paths`` have."""
    found = []
    with AnyReader(paths) as reader:
        for connection, _, data in reader.messages():
            if connection.topic == '/cloth_sim/stats':
                found.append(reader.deserialize(data, connection.msgtype).steps)
    return found


def test_all_files_together_hold_all(split):
    """Frames would be lost, doubled or out of order where one file ends and the next begins."""
    path, _ = split
    assert len(list(path.glob('*.mcap'))) >= 3
    assert steps([path]) == list(range(FRAMES))
    reader = BagReader(path)
    clouds = [raw.time for raw in reader.messages(['/cloth_sim/points'])]
    assert clouds == [round(number * PERIOD * 1e9) for number in range(FRAMES)]
    assert reader.problems == []


def test_only_the_end_waits_for_the_disk(tmp_path, monkeypatch):
    """What comes while a busy disk takes a finished file would be lost in a crash."""
    waits, wait = [], os.fsync

    def fsync(descriptor):
        waits.append(os.fstat(descriptor).st_ino)
        wait(descriptor)

    monkeypatch.setattr(os, 'fsync', fsync)
    writer = BagWriter(tmp_path, RecordingOptions(max_bagfile_duration=1.0))
    channel = topic_channel(TOPICS['stats'], 'cloth_sim')
    for number in range(4):
        writer.write(channel, bytes(64), number * 10**9)
        writer.flush()
    assert waits == []
    writer.finish()
    assert {path.stat().st_ino for path in tmp_path.iterdir()} <= set(waits)


def test_files_keep_their_limits(split):
    """A file system that takes 4 GB a file could not take the recording."""
    path, options = split
    for file in path.glob('*.mcap'):
        assert file.stat().st_size <= options.get('max_bagfile_size', 10 * FRAMES * MIB)
        with Reader(file) as reader:
            most = options.get('max_bagfile_duration', FRAMES * PERIOD)
            assert reader.duration <= most * 1e9


def test_each_file_is_whole_by_itself(split, tmp_path):
    """A file that is opened alone would have no faces, no mode, or no types."""
    path, _ = split
    numbers = []
    for file in sorted(path.glob('*.mcap'), key=lambda file: int(file.stem[4:])):
        alone = shutil.copy(file, tmp_path)
        numbers += steps([tmp_path / file.name])
        with open(alone, 'rb') as stream:
            reader = make_reader(stream)
            first = [channel.topic for _, channel, _ in reader.iter_messages()][:2]
            summary = reader.get_summary()
        assert sorted(first) == ['/cloth_sim/state', '/cloth_sim/topology']
        assert len(summary.channels) == 4
        reader = BagReader(alone)
        assert summary.statistics.message_count == sum(1 for _ in reader.messages())
        assert reader.problems == []
    assert numbers == list(range(FRAMES))


def test_metadata_is_that_of_a_split_bag_of_rosbag2(split):
    """`ros2 bag play` would play the first file alone, or seek in the wrong one."""
    path, _ = split
    content = yaml.safe_load((path / 'metadata.yaml').read_text())['rosbag2_bagfile_information']
    names = [f'run_{number}.mcap' for number in range(len(list(path.glob('*.mcap'))))]
    assert content['relative_file_paths'] == names
    assert [entry['path'] for entry in content['files']] == names
    for entry in content['files']:
        with Reader(path / entry['path']) as reader:
            assert entry['message_count'] == reader.message_count
            assert entry['starting_time']['nanoseconds_since_epoch'] == reader.start_time
            assert entry['duration']['nanoseconds'] == reader.duration - 1
    assert content['message_count'] == sum(
        entry['message_count'] for entry in content['files'])
    assert content['duration']['nanoseconds'] == round((FRAMES - 1) * PERIOD * 1e9)


def test_a_missing_file_is_named(split, tmp_path):
    """A part of the run would be missing without a word."""
    path, _ = split
    copy = shutil.copytree(path, tmp_path / 'run')
    (copy / 'run_1.mcap').unlink()
    reader = BagReader(copy)
    assert 0 < sum(raw.topic.endswith('stats') for raw in reader.messages()) < FRAMES
    assert f'run_1.mcap of {copy} is missing' in reader.problems[0]


def test_a_file_that_metadata_does_not_have_yet_is_read(split, tmp_path):
    """A run that is killed as a file begins would lose what was flushed of that."""
    path, _ = split
    copy = shutil.copytree(path, tmp_path / 'run')
    text = (copy / 'metadata.yaml').read_text()
    content = yaml.safe_load(text)
    content['rosbag2_bagfile_information']['relative_file_paths'] = ['run_0.mcap']
    (copy / 'metadata.yaml').write_text(yaml.safe_dump(content))
    assert sum(
        raw.topic.endswith('stats') for raw in BagReader(copy).messages()) == FRAMES


@pytest.mark.parametrize('most', [MIB, 3 * MIB, 5 * MIB])
@pytest.mark.parametrize('options', [
    {}, {'max_bagfile_size': MIB}, {'max_bagfile_duration': 1.0}], ids=str)
def test_a_recording_stays_within_its_size_and_is_whole(tmp_path, most, options):
    """A long run would fill the disk, or leave a recording without an index."""
    path, full = record(tmp_path, max_size=most, **options)
    size = sum(file.stat().st_size for file in path.iterdir())
    assert 0.5 * most < size <= most
    assert f'the recording {path} is complete up to ' in str(full)
    assert f'recording.max_size {most} bytes: set a larger limit' in str(full)
    found = steps([path])
    assert found == list(range(len(found)))
    reader = BagReader(path)
    assert reader.span[1] == pytest.approx(float(str(full).split(' up to ')[1].split()[0]) * 1e9)
    assert reader.problems == []


def test_a_recording_below_its_size_ends_with_its_close(tmp_path):
    """Each recording with a limit would be said to be cut."""
    path, full = record(tmp_path, frames=10, max_size=100 * MIB)
    assert full is None
    assert steps([path]) == list(range(10))
