# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Frame of each pin and the force on it, as serialised bytes."""

import struct

from cloth_sim_ros.messages.frame_names import pin_frame
from cloth_sim_ros.messages.stamp import STAMP
from cloth_sim_ros.messages.stamp import STAMP_AT
from cloth_sim_ros.messages.stamp import stamp_parts
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from cloth_sim_ros.sim.snapshot import Snapshot
from geometry_msgs.msg import Transform
from geometry_msgs.msg import TransformStamped
from geometry_msgs.msg import Vector3
from geometry_msgs.msg import Wrench
from geometry_msgs.msg import WrenchStamped
import numpy as np
from rclpy.serialization import serialize_message
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

_FIRST_STAMP_AT = 8  # behind the encapsulation and the length of the list
_PLACE = struct.Struct('<3d')
_ROTATION = struct.calcsize('<4d')
_MARK = (1.25, -2.5, 5e300)  # stands for a place or a force when looking for its bytes


class PinFrames:
    """
    TFMessage of all pins: the origin of a pin's frame is its node, the axes are the parent's.

    :param node_name: with its namespace, so that the pins of two nodes differ
    :param frame_id: the parent, frame of the positions
    """

    def __init__(self, node_name: str, frame_id: str) -> None:
        """Serialise nothing yet: pins come and go."""
        self._node_name = node_name
        self._frame_id = frame_id
        self._pins: list[list[int]] | None = None
        self._template = bytearray()
        self._fields: list[tuple[int, int]] = []

    def serialise(
            self, snapshot: Snapshot, held: np.ndarray | None = None, epoch: int = 0) -> bytes:
        """
        Return the CDR bytes of the frames of ``snapshot``, row by row of the pins.

        :param held: (rows, cols) bool, nodes to leave out: they have the frame of their grasp
        :param epoch: stamp of simulated time 0 [ns]
        """
        pinned = snapshot.flags & FLAG_PINNED != 0
        if held is not None:
            pinned &= ~held
        pins = np.argwhere(pinned).tolist()
        if pins != self._pins:
            self._make_template(pins)
        time = stamp_parts(snapshot.time, epoch)
        for (stamp_at, place_at), place in zip(self._fields, snapshot.positions[pinned].tolist()):
            STAMP.pack_into(self._template, stamp_at, *time)
            _PLACE.pack_into(self._template, place_at, *place)
        return bytes(self._template)

    def _make_template(self, pins: list[list[int]]) -> None:
        """Serialise the names, and find where the stamp and the place of each pin stand."""
        x, y, z = _MARK
        self._pins = pins
        self._template = bytearray(serialize_message(TFMessage(transforms=[
            TransformStamped(
                header=Header(frame_id=self._frame_id),
                child_frame_id=pin_frame(self._node_name, row, col),
                transform=Transform(translation=Vector3(x=x, y=y, z=z)))
            for row, col in pins])))
        self._fields = []
        stamp_at = _FIRST_STAMP_AT
        for _ in pins:
            place_at = self._template.index(_PLACE.pack(*_MARK), stamp_at)
            self._fields.append((stamp_at, place_at))
            stamp_at = place_at + _PLACE.size + _ROTATION


# What each pin feels, as one message a pin, already in the bytes that go out.

# More would keep the node from stepping; subscribers must have room for all of a frame.
MOST_PINS = 1024

_FORCE = struct.Struct('<3d')


class WrenchMessages:
    """
    WrenchStamped of each pin: the force of the cloth on its holder [N].

    It is what a force sensor in the gripper measures, with the gripper's own weight taken off. A
    node is a point, so the torque is 0. The frame of a message is that of its pin.

    :param node_name: with its namespace
    """

    def __init__(self, node_name: str) -> None:
        """Serialise nothing yet: pins come and go."""
        self._node_name = node_name
        self._templates: dict[tuple[int, int], tuple[bytearray, int]] = {}

    def serialise(
            self, nodes: np.ndarray, forces: np.ndarray, sim_time: float,
            epoch: int = 0) -> list[bytes]:
        """
        Return the CDR bytes of each message of a frame at ``sim_time`` [s].

        :param nodes: rows and columns of pins, (pins, 2) int
        :param forces: of the cloth on each [N], (pins, 3)
        :param epoch: stamp of simulated time 0 [ns]
        """
        time = stamp_parts(sim_time, epoch)
        messages = []
        for node, force in zip(nodes.tolist(), forces.tolist()):
            data, place = self._template(*node)
            STAMP.pack_into(data, STAMP_AT, *time)
            _FORCE.pack_into(data, place, *force)
            messages.append(bytes(data))
        return messages

    def _template(self, row: int, col: int) -> tuple[bytearray, int]:
        """Return the message of a pin, and the place of its force."""
        if (row, col) not in self._templates:
            x, y, z = _MARK
            data = serialize_message(WrenchStamped(
                header=Header(frame_id=pin_frame(self._node_name, row, col)),
                wrench=Wrench(force=Vector3(x=x, y=y, z=z))))
            self._templates[row, col] = bytearray(data), data.index(_FORCE.pack(*_MARK))
        return self._templates[row, col]


def too_many_pins(pins: int) -> str:
    """Return why nothing is sent of so many pins; empty when something is."""
    if pins <= MOST_PINS:
        return ''
    return (
        f'~/pins/wrenches and the pin frames on /tf are limited to {MOST_PINS} pins and there are '
        f'{pins}, so neither is published: release some, or set publish.wrenches: false and '
        'publish.tf: false')
