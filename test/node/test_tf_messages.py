# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Transforms are read from bytes as rclpy reads them."""

import math

from builtin_interfaces.msg import Time
from cloth_sim_ros.node.tf_messages import checked_pose
from cloth_sim_ros.node.tf_messages import read_transforms
from cloth_sim_ros.sim.errors import ClothSimError
from geometry_msgs.msg import Quaternion
from geometry_msgs.msg import Transform
from geometry_msgs.msg import TransformStamped
from geometry_msgs.msg import Vector3
import numpy as np
import pytest
from rclpy.serialization import serialize_message
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

NAMES = ('', 'a', 'ab', 'abc', 'abcd', 'tool0_link', 'Größe', '/old')


def message_of(names, generator):
    """Return a TFMessage with a transform between any two of ``names``."""
    return TFMessage(transforms=[
        TransformStamped(
            header=Header(stamp=Time(
                sec=int(generator.integers(-5, 2**31 - 1)),
                nanosec=int(generator.integers(10**9))), frame_id=parent),
            child_frame_id=frame, transform=Transform(
                translation=Vector3(**dict(zip('xyz', generator.normal(size=3).tolist()))),
                rotation=Quaternion(**dict(zip('xyzw', generator.normal(size=4).tolist())))))
        for parent in names for frame in names])


@pytest.mark.parametrize('names', [NAMES, NAMES[3:5], ()])
def test_it_is_read_as_rclpy_reads_it(names):
    """A frame would get the place, the parent or the time of another one."""
    message = message_of(names, np.random.default_rng(2))
    read = list(read_transforms(bytes(serialize_message(message))))
    assert len(read) == len(message.transforms)
    for (frame, time, parent, place), told in zip(read, message.transforms):
        stamp, at, turn = told.header.stamp, told.transform.translation, told.transform.rotation
        assert frame == told.child_frame_id.removeprefix('/')
        assert parent == told.header.frame_id.removeprefix('/')
        assert time == stamp.sec * 10**9 + stamp.nanosec
        assert place == (at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w)


def test_bytes_that_are_no_transforms_are_refused():
    """A broken message would be half taken without a word, or end the node."""
    whole = bytes(serialize_message(message_of(NAMES[:3], np.random.default_rng(2))))
    for broken in (b'\x00\x01\x00\x00', b'\x00\x01\x00\x00\xff\xff\xff\x7f', whole[:-1]):
        with pytest.raises(ClothSimError, match='it is no TFMessage'):
            list(read_transforms(broken))
    name = whole.index(b'ab\x00')
    with pytest.raises(ClothSimError, match='it is no TFMessage'):
        list(read_transforms(whole[:name] + b'\xff\xfe' + whole[name + 2:]))


@pytest.mark.parametrize('place, reason', [
    ((math.nan, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0), 'finite numbers, got [nan, 0.0'),
    ((0.0, 0.0, 0.0, 0.0, 0.0, math.inf, 1.0), 'finite numbers'),
    ((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), 'of length 1, got [0.0, 0.0, 0.0, 0.0]'),
    ((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.02), 'of length 1, got [0.0, 0.0, 0.0, 1.02]')])
def test_a_transform_that_makes_no_sense_is_refused(place, reason):
    """A robot that is not ready yet would send the cloth to no place."""
    with pytest.raises(ClothSimError) as refused:
        checked_pose('tool0', place)
    assert "the frame 'tool0' must" in str(refused.value) and reason in str(refused.value)


def test_a_rotation_is_made_a_unit():
    """Each link of a chain would stretch what comes after it."""
    pose = checked_pose('tool0', (1.0, 2.0, 3.0, 0.0, 0.6003, 0.0, 0.8004))
    assert pose.position == (1.0, 2.0, 3.0)
    assert pose.orientation == pytest.approx((0.0, 0.6, 0.0, 0.8), abs=1e-15)
