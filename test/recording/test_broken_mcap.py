# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Mcap files without their end, of any writer."""

from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.recording.broken_mcap import BrokenMcap
from mcap.writer import CompressionType
from mcap.writer import IndexType
from mcap.writer import Writer
import pytest
from rosbags.interfaces import MessageDefinitionFormat

MESSAGES = 200


@pytest.fixture(params=[
    {}, {'use_chunking': False}, {'index_types': IndexType.NONE},
    {'compression': CompressionType.LZ4}, {'compression': CompressionType.NONE},
    {'repeat_channels': False, 'use_statistics': False}], ids=str)
def written(request, tmp_path):
    """Return an mcap file as writers may make it, with two topics, the second late."""
    path = tmp_path / 'run.mcap'
    with open(path, 'wb') as stream:
        writer = Writer(stream, **{
            'chunk_size': 2000, 'compression': CompressionType.ZSTD, **request.param})
        writer.start(profile='ros2')
        schema = writer.register_schema('std_msgs/msg/String', 'ros2msg', b'string data')
        early = writer.register_channel('/early', 'cdr', schema)
        for number in range(MESSAGES):
            if number == MESSAGES // 2:
                other = writer.register_schema('other/msg/Strange', 'strange', b'?')
                late = writer.register_channel('/late', 'cdr', other)
            channel = early if number < MESSAGES // 2 or number % 2 else late
            writer.add_message(channel, number, b'%050d' % number, number)
        writer.finish()
    return path


@pytest.mark.parametrize('share', [0.85, 0.7, 0.4, 0.1])
def test_all_whole_records_come(written, share):
    """A broken file of another writer would lose messages, or topics that came late."""
    content = written.read_bytes()
    written.write_bytes(content[:int(share * len(content))])
    bag = BrokenMcap(written)
    read = list(bag.messages(None))
    assert [int(message.data) for message in read] == list(range(len(read)))
    assert [message.time for message in read] == list(range(len(read)))
    assert {topic.name: topic.count for topic in bag.topics if topic.count} == {
        name: count for name in ('/early', '/late')
        if (count := sum(message.topic == name for message in read))}
    assert 'is truncated' in bag.problem
    # All but what the index at the end takes, and the chunk that was cut.
    assert len(read) >= int(share * MESSAGES) - 80


def test_a_whole_file_that_rosbags_refuses_has_no_problem(written):
    """A file with a type of a strange kind would be said to be cut off."""
    bag = BagReader(written)
    assert len(list(bag.messages())) == MESSAGES
    assert bag.problems == []
    formats = {topic.name: topic.definition.format for topic in bag.topics}
    assert formats == {
        '/early': MessageDefinitionFormat.MSG, '/late': MessageDefinitionFormat.NONE}


@pytest.mark.parametrize('written', [{'compression': CompressionType.NONE}], indirect=True)
def test_a_chunk_with_a_wrong_byte_is_not_believed(written):
    """A number that a disk or a cable has changed would be taken for one of the recording."""
    content = written.read_bytes()
    assert content.count(b'%050d' % 190) == 1
    written.write_bytes(content.replace(b'%050d' % 190, b'%050d' % 7))
    bag = BagReader(written)
    read = [(message.time, int(message.data)) for message in bag.messages()]
    assert len(read) > MESSAGES // 2
    assert all(time == number for time, number in read)
    assert 'checksum' in ' '.join(bag.problems)
