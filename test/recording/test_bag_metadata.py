# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What rosbag2 wants to know of a bag before it opens it."""

from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.recording.bag_metadata import BagMetadata
from cloth_sim_ros.recording.message_definition import type_hash
from cloth_sim_ros.recording.recorder import offered_qos
from cloth_sim_ros.recording.recorder import topic_channel
import pytest
import yaml

STATS = topic_channel(TOPICS['stats'], 'cloth_sim')


def read(folder):
    """Return the content of metadata.yaml."""
    return yaml.safe_load((folder / 'metadata.yaml').read_text())['rosbag2_bagfile_information']


@pytest.fixture
def metadata():
    """Return the metadata of a bag with one topic, and no messages yet."""
    made = BagMetadata('a_0.mcap')
    made.add_topic(STATS)
    return made


def test_content_is_that_of_version_9(metadata, tmp_path):
    """Players would refuse the bag, or show other topics and times than it holds."""
    for time in (2_500_000_000, 1_500_000_000, 4_000_000_000):
        metadata.add_message(STATS, time)
    metadata.write(tmp_path)
    times = {
        'duration': {'nanoseconds': 2_500_000_000},
        'starting_time': {'nanoseconds_since_epoch': 1_500_000_000}}
    assert read(tmp_path) == {
        **times, 'version': 9, 'storage_identifier': 'mcap', 'message_count': 3,
        'topics_with_message_count': [{
            'topic_metadata': {
                'name': '/cloth_sim/stats', 'type': 'cloth_sim_interfaces/msg/ClothStats',
                'serialization_format': 'cdr',
                'offered_qos_profiles': offered_qos(TOPICS['stats']),
                'type_description_hash': type_hash('cloth_sim_interfaces/msg/ClothStats')},
            'message_count': 3}],
        'compression_format': '', 'compression_mode': '', 'relative_file_paths': ['a_0.mcap'],
        'files': [{'path': 'a_0.mcap', 'message_count': 3, **times}],
        'custom_data': None, 'ros_distro': 'jazzy'}
    assert yaml.safe_load(metadata.text()) == read(tmp_path)


def test_keeps_what_else_is_to_be_known(tmp_path):
    """A recording would not say which version has made it."""
    metadata = BagMetadata('a_0.mcap', {'maker': '1.2'})
    metadata.write(tmp_path)
    assert read(tmp_path)['custom_data'] == {'maker': '1.2'}


def test_an_empty_bag_has_no_time_yet(metadata, tmp_path):
    """Players would find a negative duration and stop."""
    metadata.write(tmp_path)
    content = read(tmp_path)
    assert content['duration'] == {'nanoseconds': 0}
    assert content['starting_time'] == {'nanoseconds_since_epoch': 2**63 - 1}


def test_writing_again_leaves_one_file(metadata, tmp_path):
    """Half a file would be left behind, or the old one kept."""
    metadata.write(tmp_path)
    metadata.add_message(STATS, 5)
    metadata.write(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ['metadata.yaml']
    assert read(tmp_path)['message_count'] == 1


def test_a_failed_write_keeps_the_old_file(metadata, tmp_path):
    """A full disk would take the metadata of what is recorded already."""
    metadata.write(tmp_path)
    (tmp_path / 'metadata.yaml.new').symlink_to('/dev/full')
    metadata.add_message(STATS, 5)
    with pytest.raises(OSError, match='No space left'):
        metadata.write(tmp_path)
    assert read(tmp_path)['message_count'] == 0
    assert [path.name for path in tmp_path.iterdir()] == ['metadata.yaml']


def test_each_file_has_times_of_its_own(metadata, tmp_path):
    """A player would begin the second file at the time of the first."""
    metadata.add_message(STATS, 5)
    metadata.begin_file('a_1.mcap')
    for time in (7, 9):
        metadata.add_message(STATS, time)
    metadata.write(tmp_path)
    content = read(tmp_path)
    assert content['relative_file_paths'] == ['a_0.mcap', 'a_1.mcap']
    assert [file['message_count'] for file in content['files']] == [1, 2]
    assert content['files'][1]['starting_time'] == {'nanoseconds_since_epoch': 7}
    assert content['files'][1]['duration'] == {'nanoseconds': 2}
    assert (content['message_count'], content['duration']) == (3, {'nanoseconds': 4})
