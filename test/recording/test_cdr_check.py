# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Whether the lengths within a CDR message fit its bytes."""

from pathlib import Path

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.recording.bag_messages import MessageDecoder
from cloth_sim_ros.recording.bag_messages import RawMessage
from cloth_sim_ros.recording.bag_reader import BagReader
from geometry_msgs.msg import Point
from geometry_msgs.msg import TransformStamped
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import ColorRGBA
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker
from visualization_msgs.msg import MarkerArray

EXAMPLE = Path(__file__).resolve().parents[2] / 'bags' / 'example'
FULL = [
    ('tf2_msgs/msg/TFMessage', TFMessage(transforms=[
        TransformStamped(child_frame_id='x' * number) for number in range(9)])),
    ('sensor_msgs/msg/PointCloud2', PointCloud2(data=bytes(10_001), is_dense=True)),
    ('visualization_msgs/msg/MarkerArray', MarkerArray(markers=[
        Marker(ns='a' * number, points=[Point()] * number, colors=[ColorRGBA()] * 3 * number,
               text='text') for number in range(9)])),
    ('cloth_sim_interfaces/msg/ClothState', ClothState(mode='adaptive'))]


def problem(name, data):
    """Return what is wrong with ``data`` of the type ``name``."""
    return MessageDecoder([]).problem(RawMessage('/topic', name, 0, data))


def test_all_of_a_recording_is_right():
    """Messages would be left out for nothing."""
    bag = BagReader(EXAMPLE)
    found = [bag.problem_of(message) for message in bag.messages()]
    assert len(found) > 100 and not any(found)


@pytest.mark.parametrize('key', TOPICS)
def test_empty_messages_of_each_topic_are_right(key):
    """A topic would never be played."""
    topic = TOPICS[key]
    assert problem(topic.type_name, serialize_message(topic.message())) == ''


@pytest.mark.parametrize(('name', 'message'), FULL)
def test_a_message_that_is_cut_off_is_found(name, message):
    """A reader would wait for bytes that never come, or read those behind."""
    data = serialize_message(message)
    assert problem(name, data) == ''
    # The middleware fills up to a multiple of 4 bytes, and more in nested lists.
    needed = next(size for size in range(len(data) + 1) if not problem(name, data[:size]))
    assert len(data) - needed < 64
    assert all(problem(name, data[:size]) for size in range(0, needed, 7))


@pytest.mark.parametrize(('name', 'message'), FULL)
def test_a_forged_length_is_found(name, message):
    """A reader would allocate gigabytes."""
    data = serialize_message(message)
    header = name in ('sensor_msgs/msg/PointCloud2', 'cloth_sim_interfaces/msg/ClothState')
    at = 12 if header else 4  # behind a stamp, or first of all
    for length in (len(data), 2**31, 2**32 - 1):
        forged = data[:at] + length.to_bytes(4, 'little') + data[at + 4:]
        assert 'has a length that needs' in problem(name, forged)


def test_what_is_no_cdr_is_found():
    """Bytes that no middleware reads would be sent."""
    name, data = 'cloth_sim_interfaces/msg/ClothState', serialize_message(ClothState())
    assert 'fewer than' in problem(name, b'') and 'fewer than' in problem(name, b'\0\1\0')
    assert 'not plain CDR' in problem(name, b'\x77\x77' + data[2:])


def test_a_type_that_is_not_known_is_left_alone():
    """A recording of another program's type could not be played."""
    assert problem('other_msgs/msg/Other', b'\0\1\0\0\1') == ''
