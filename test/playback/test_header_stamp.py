# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Stamps of messages that are not decoded."""

from builtin_interfaces.msg import Time
from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.playback.header_stamp import has_header
from cloth_sim_ros.playback.header_stamp import header_stamp
import pytest
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import PointCloud2
from shape_msgs.msg import Mesh
from std_msgs.msg import Header


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
