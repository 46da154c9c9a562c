# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The version that a recording names."""

from cloth_sim_ros.recording.project_version import project_version
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.resimulation.recorded_version import recorded_version
import pytest
from rosbags.rosbag2 import Reader


@pytest.fixture
def bag(tmp_path):
    """Return the folder of a recording."""
    recorder = Recorder(tmp_path, 'made', 'cloth_sim')
    recorder.write('points', b'\x00\x01\x00\x00', 0.0)
    recorder.close()
    return recorder.path


def test_a_recording_names_its_version(bag):
    """Runs of two versions would be compared without a word."""
    assert project_version()
    assert recorded_version(bag) == recorded_version(bag / 'made_0.mcap') == project_version()


def test_other_readers_take_it(bag):
    """A recording could not be opened because of what only this project needs."""
    with Reader(bag) as reader:
        assert reader.message_count == 1


@pytest.mark.parametrize('text', [
    '', '[1, 2]', 'a: [', 'rosbag2_bagfile_information: 3', b'\xff\xfe\x00',
    'rosbag2_bagfile_information: {custom_data: null}',
    'rosbag2_bagfile_information: {custom_data: {cloth_sim_ros: 1.0}}'])
def test_foreign_metadata_name_none(bag, text):
    """A foreign recording would end as a traceback."""
    data = text if isinstance(text, bytes) else text.encode()
    (bag / 'metadata.yaml').write_bytes(data)
    assert recorded_version(bag) == ''


def test_a_recording_without_metadata_names_none(bag):
    """A recording that lost its metadata would end as a traceback."""
    (bag / 'metadata.yaml').unlink()
    assert recorded_version(bag) == ''
