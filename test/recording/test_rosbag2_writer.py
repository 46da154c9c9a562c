# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A bag that rosbag2_py writes, where a sourced ROS has that."""

import os
from pathlib import Path
import subprocess
import sys

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.recording.bag_folder import RecordingOptions
from cloth_sim_ros.recording.bag_metadata import folder_metadata
from cloth_sim_ros.recording.bag_metadata import PACKAGE
from cloth_sim_ros.recording.bag_metadata import project_version
from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.recording.recording_faults import RecordingError
from made_cloud import make_cloud
import pytest
from rclpy.serialization import deserialize_message
from rclpy.serialization import serialize_message
from rosbags.highlevel import AnyReader
from sensor_msgs.msg import PointCloud2

# Wheels of ROS have no rosbag2_py; a sourced ROS has.
pytest.importorskip('rosbag2_py')
PROGRAMS = Path(__file__).resolve().parent / 'programs'
FRAMES, SIDE, PERIOD = 60, 48, 0.02


def record(folder, library, **options):
    """Return the folder of a recording of clouds that don't compress, written by ``library``."""
    recorder = Recorder(folder, library, options=RecordingOptions(**options), library=library)
    recorder.write('state', serialize_message(ClothState(mode='adaptive')), 0.0)
    for number in range(FRAMES):
        time = number * PERIOD
        recorder.write('stats', serialize_message(ClothStats(steps=number)), time)
        recorder.write('points', make_cloud(SIDE, SIDE, number)[0], time)
    recorder.close()
    return recorder.path


@pytest.mark.parametrize('options', [
    {}, {'max_bagfile_size': 2 * 2**20}, {'max_bagfile_duration': 0.5}], ids=str)
def test_it_writes_what_mcap_writes(tmp_path, options):
    """A recording of a sourced ROS would be another one, or not be read by anything."""
    path = record(tmp_path, 'rosbag2_py', **options)
    assert len(list(path.glob('*.mcap'))) > (1 if options else 0)
    assert folder_metadata(path)['custom_data'] == {PACKAGE: project_version()}
    reader, other = BagReader(path), BagReader(record(tmp_path, 'mcap'))
    assert not reader.problems
    for topic, kind in (('points', PointCloud2), ('state', ClothState), ('stats', ClothStats)):
        # Decoded, as padding differs from message to message.
        found, expected = ([
            (raw.time, deserialize_message(bytes(raw.data), kind))
            for raw in each.messages([f'/cloth_sim/{topic}'])] for each in (reader, other))
        assert found == expected, topic
    with AnyReader([path]) as rosbags, AnyReader([tmp_path / 'mcap']) as others:
        assert {each.topic: each.ext for each in rosbags.connections} == {
            each.topic: each.ext for each in others.connections}, 'offered qualities of service'


def test_a_file_that_is_gone_is_said(tmp_path):
    """rosbag2 would complete a recording of which nothing is left."""
    recorder = Recorder(tmp_path, 'run', library='rosbag2_py')
    recorder.write('stats', serialize_message(ClothStats()), 0.0)
    (recorder.path / 'run_0.mcap').unlink()
    with pytest.raises(RecordingError, match='run_0.mcap|No such file'):
        recorder.close()


def test_a_full_disk_is_said(tmp_path):
    """rosbag2 does not look at what a write returns: half of a recording would be lost."""
    done = subprocess.run(
        [sys.executable, str(PROGRAMS / 'full_disk_rosbag2.py'), str(tmp_path)],
        env=os.environ, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    assert 'has stopped (rosbag2 has not written all of run_0.mcap' in done.stdout
