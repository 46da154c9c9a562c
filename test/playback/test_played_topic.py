# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A topic is played no faster than its readers take it."""

from signal import SIGCONT
from signal import SIGSTOP
import subprocess
import sys

from cloth_sim_ros.playback.played_topic import PlayedTopic
import pytest
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from rclpy.serialization import serialize_message
from std_msgs.msg import Int32

DEPTH = 10
MESSAGES = 200
_READER = f"""
import rclpy
from rclpy.qos import QoSProfile
from std_msgs.msg import Int32
rclpy.init()
node = rclpy.create_node('reader')
received = []
node.create_subscription(
    Int32, '/played', lambda message: received.append(message.data), QoSProfile(depth=1000))
print('ready', flush=True)
while not received or received[-1] != {MESSAGES - 1}:
    rclpy.spin_once(node, timeout_sec=0.1)
print(*received)
"""


@pytest.fixture
def reader():
    """Run a process that prints what it has read, when it has the last message."""
    process = subprocess.Popen([sys.executable, '-c', _READER], stdout=subprocess.PIPE, text=True)
    process.stdout.readline()
    yield process
    process.kill()
    process.wait()
    process.stdout.close()


def played(client, name='/played', patience=0.2, **quality):
    """Return a topic that its reader knows."""
    topic = PlayedTopic(
        client.node, name, Int32, QoSProfile(depth=DEPTH, **quality), patience=patience)
    client.spin_until(lambda: is_read(client, name), 'the reader is found')
    client.spin_for(0.2)
    return topic


def is_read(client, name):
    """Tell whether the publisher of ``name`` has a reader."""
    return any(
        publisher.get_subscription_count() for publisher in client.node.publishers
        if publisher.topic_name == name)


def test_a_burst_loses_nothing(client, reader):
    """What is caught up with would be lost, as the publisher keeps its last messages only."""
    # A busy machine may not let the reader run for a while.
    topic = played(client, patience=30.0)
    for number in range(MESSAGES):
        topic.publish(serialize_message(Int32(data=number)))
    numbers, _ = reader.communicate(timeout=30.0)
    assert [int(number) for number in numbers.split()] == list(range(MESSAGES))
    assert topic.overruns == 0


def test_a_reader_that_hangs_holds_nobody_up_and_is_told(client, reader):
    """One hung viewer would stop playing for all, or lose messages without a word."""
    topic = played(client)
    reader.send_signal(SIGSTOP)
    for number in range(MESSAGES - 1):
        topic.publish(serialize_message(Int32(data=number)))
    assert topic.overruns == MESSAGES - 1 - DEPTH
    reader.send_signal(SIGCONT)
    topic.publish(serialize_message(Int32(data=MESSAGES - 1)))
    numbers, _ = reader.communicate(timeout=30.0)
    assert len(numbers.split()) >= DEPTH


def test_best_effort_waits_for_nobody(client):
    """It would wait for an answer that never comes."""
    quality = {'reliability': ReliabilityPolicy.BEST_EFFORT}
    client.node.create_subscription(
        Int32, '/other', lambda _: None, QoSProfile(depth=1, **quality))
    topic = played(client, '/other', **quality)
    for number in range(MESSAGES):
        topic.publish(serialize_message(Int32(data=number)))
    assert topic.overruns == 0
