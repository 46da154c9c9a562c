# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The topics of a recording that can be played, opened for publishing."""

import os
from signal import SIGCONT
from signal import SIGSTOP
import subprocess
import sys
from threading import Timer

from builtin_interfaces.msg import Time
from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.playback.played_topics import has_header
from cloth_sim_ros.playback.played_topics import header_stamp
from cloth_sim_ros.playback.played_topics import message_class
from cloth_sim_ros.playback.played_topics import PATIENCE
from cloth_sim_ros.playback.played_topics import played_quality
from cloth_sim_ros.playback.played_topics import PlayedTopic
from cloth_sim_ros.recording.bag_metadata import yaml_text
from cloth_sim_ros.recording.message_definition import message_definition
from cloth_sim_ros.recording.recorder import offered_qos
from cloth_sim_ros.sim.errors import ClothSimError
import pytest
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from rclpy.serialization import serialize_message
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import MessageDefinitionFormat
from rosbags.rosbag2.metadata import parse_qos
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import PointCloud2
from shape_msgs.msg import Mesh
from std_msgs.msg import Header
from std_msgs.msg import Int32

CLOUD = 'sensor_msgs/msg/PointCloud2'
DEPTH = 10
MESSAGES = 200
_READER = f"""
import rclpy
from rclpy.qos import QoSProfile
from std_msgs.msg import Int32
rclpy.init()
node = rclpy.create_node('reader')
received = []
subscription = node.create_subscription(
    Int32, '/played', lambda message: received.append(message.data), QoSProfile(depth=1000))
print('ready', flush=True)
while not subscription.get_publisher_count():
    rclpy.spin_once(node, timeout_sec=0.1)
print('found', flush=True)
while not received or received[-1] != {MESSAGES - 1}:
    rclpy.spin_once(node, timeout_sec=0.1)
print(*received)
"""


@pytest.mark.parametrize('message_class', [ClothStats, PointCloud2])
@pytest.mark.parametrize('time', [(0, 0), (3, 20_000_000), (2**31 - 1, 999_999_999), (-2, 5)])
def test_stamp_is_that_of_the_message(message_class, time):
    """The clock would tell another time than the messages."""
    stamp = Time(sec=time[0], nanosec=time[1])
    message = message_class(header=Header(stamp=stamp, frame_id='world'))
    assert has_header(message_class)
    assert header_stamp(serialize_message(message)) == stamp


def test_big_endian_is_read():
    """A recording of another machine would give times of centuries."""
    data = b'\x00\x00\x00\x00' + (7).to_bytes(4, 'big') + (8).to_bytes(4, 'big')
    assert header_stamp(data) == Time(sec=7, nanosec=8)


@pytest.mark.parametrize('message_class', [Mesh, Clock])
def test_others_have_no_stamp(message_class):
    """Some other number of the message would be taken for a time."""
    assert not has_header(message_class)


def profiles(*changes):
    """Return profiles like that of the points, but for the changes of each."""
    usual, = offered_qos(TOPICS['points'])
    return parse_qos(yaml_text([{**usual, **change} for change in changes]))


def offered(quality):
    """Return the parts of a quality that tell."""
    return (
        quality.depth, quality.reliability == ReliabilityPolicy.RELIABLE,
        quality.durability == DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.mark.parametrize('key', TOPICS)
def test_what_this_project_recorded_is_offered_again(key):
    """Readers of the simulation would not get what is played, or late ones no topology."""
    topic = TOPICS[key]
    quality = played_quality(
        topic.full_name('cloth_sim'), topic.type_name, parse_qos(yaml_text(offered_qos(topic))))
    assert offered(quality) == (topic.depth, topic.reliable, topic.transient_local)


def test_of_several_publishers_the_best_is_offered():
    """A reader of one of them would get nothing."""
    mixed = profiles(
        {'reliability': 'best_effort'}, {'durability': 'transient_local', 'depth': 3})
    assert offered(played_quality('/a', CLOUD, mixed)) == (10, True, True)
    assert offered(played_quality('/a', CLOUD, mixed[:1])) == (10, False, False)


@pytest.mark.parametrize(('name', 'key', 'depth'), [
    ('/cloth_sim/pins/wrenches', 'pins/wrenches', TOPICS['pins/wrenches'].depth),
    ('/a/cloth_sim/topology', 'topology', TOPICS['topology'].depth),
    ('/scan', 'points', 10)])
def test_a_depth_that_was_not_recorded_is_the_usual_one(name, key, depth):
    """A bag of `ros2 bag record`, which can't know it, would be played with a depth of 0."""
    topic = TOPICS[key]
    unknown = profiles({'history': 'unknown', 'depth': 0})
    assert played_quality(name, topic.type_name, unknown).depth == depth
    assert offered(played_quality(name, topic.type_name, ())) == (depth, True, False)


@pytest.fixture
def reader():
    """Run a process that prints the messages it read, after the last one."""
    process = subprocess.Popen([sys.executable, '-c', _READER], stdout=subprocess.PIPE, text=True)
    process.stdout.readline()
    yield process
    process.kill()
    process.wait()
    process.stdout.close()


def played(client, name='/played', patience=0.2, reader=None, **quality):
    """Return a topic that its reader knows, which says so if it is a process."""
    topic = PlayedTopic(
        client.node, name, Int32, QoSProfile(depth=DEPTH, **quality), patience=patience)
    client.spin_until(lambda: client.is_read(name), 'the reader is found')
    if reader is not None:
        assert reader.stdout.readline() == 'found\n'
    return topic


def stop(reader):
    """Stop a process; until the last of its threads has stopped, it confirms what comes."""
    reader.send_signal(SIGSTOP)
    os.waitid(os.P_PID, reader.pid, os.WSTOPPED | os.WNOWAIT)


def test_a_burst_loses_nothing(client, reader):
    """What is caught up with would be lost, as the publisher keeps its last messages only."""
    # A busy machine may not let the reader run for a while.
    topic = played(client, patience=300.0, reader=reader)
    for number in range(MESSAGES):
        topic.publish(serialize_message(Int32(data=number)))
    numbers, _ = reader.communicate(timeout=300.0)
    assert [int(number) for number in numbers.split()] == list(range(MESSAGES))
    assert topic.overruns == 0


def test_a_reader_that_hangs_holds_nobody_up_and_is_told(client, reader):
    """One hung viewer would stop playing for all, or lose messages without a word."""
    topic = played(client, reader=reader)
    stop(reader)
    for number in range(MESSAGES - 1):
        topic.publish(serialize_message(Int32(data=number)))
    assert topic.overruns == MESSAGES - 1 - DEPTH
    reader.send_signal(SIGCONT)
    topic.publish(serialize_message(Int32(data=MESSAGES - 1)))
    numbers, _ = reader.communicate(timeout=300.0)
    assert len(numbers.split()) >= DEPTH


def test_late_confirmations_are_no_losses(client, reader):
    """A topic that lost nothing would be named: readers may confirm only when asked again."""
    assert PATIENCE > 3.0, 'the time between two questions of Fast DDS'
    # A busy machine may not let it run for a while.
    topic = played(client, patience=300.0, reader=reader)
    stop(reader)
    Timer(1.5, reader.send_signal, (SIGCONT,)).start()
    for number in range(MESSAGES):
        topic.publish(serialize_message(Int32(data=number)))
    numbers, _ = reader.communicate(timeout=300.0)
    assert [int(number) for number in numbers.split()] == list(range(MESSAGES))
    assert topic.overruns == 0


def test_best_effort_waits_for_nobody(client):
    """It would wait for an answer that never comes."""
    quality = {'reliability': ReliabilityPolicy.BEST_EFFORT}
    client.node.create_subscription(
        Int32, '/other', lambda _: None, QoSProfile(depth=1, **quality))
    topic = played(client, '/other', **quality)
    for number in range(MESSAGES):
        topic.publish(serialize_message(Int32(data=number)))
    assert topic.overruns == 0


# From the name of a message type to its class.

NAME = 'cloth_sim_interfaces/msg/ClothStats'
UNKNOWN = MessageDefinition(MessageDefinitionFormat.NONE, '')


def definition(text):
    """Return a definition in the language of .msg files."""
    return MessageDefinition(MessageDefinitionFormat.MSG, text)


@pytest.mark.parametrize('recorded', [UNKNOWN, definition(message_definition(NAME))])
def test_an_installed_type_is_found(recorded):
    """A recording that could be played would not be."""
    assert message_class(NAME, recorded) is ClothStats


@pytest.mark.parametrize('change', [
    ('float64 max_strain', 'float32 max_strain'), ('max_strain', 'largest_strain')])
def test_a_type_that_has_changed_is_refused(change):
    """Readers would get the bytes of one type as another: numbers without sense."""
    text = message_definition(NAME)
    assert change[0] in text
    with pytest.raises(ClothSimError, match='had another definition when this was recorded'):
        message_class(NAME, definition(text.replace(*change)))


@pytest.mark.parametrize('name', [
    'no_such_msgs/msg/Thing', 'sensor_msgs/msg/NoSuchThing', 'os/msg/Path'])
def test_what_is_not_installed_is_named(name):
    """The user would not learn what to install."""
    with pytest.raises(ClothSimError, match=f'{name} is not installed'):
        message_class(name, UNKNOWN)


@pytest.mark.parametrize('name', ['', 'Header', 'std_msgs/Header', 'std_msgs/srv/Set', '../msg/A'])
def test_what_is_no_type_is_said(name):
    """A broken recording would make Python import something else."""
    with pytest.raises(ClothSimError, match='is not a message type'):
        message_class(name, UNKNOWN)
