# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where each pin is: a frame of tf2 at its node, in the bytes that go out."""

import struct

from cloth_sim_ros.messages.pin_names import pin_frame
from cloth_sim_ros.messages.stamp import stamp
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from cloth_sim_ros.sim.snapshot import Snapshot
from geometry_msgs.msg import Transform
from geometry_msgs.msg import TransformStamped
from geometry_msgs.msg import Vector3
import numpy as np
from rclpy.serialization import serialize_message
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

_STAMP = struct.Struct('<iI')
_FIRST_STAMP_AT = 8  # behind the encapsulation and the length of the list
_PLACE = struct.Struct('<3d')
_ROTATION = struct.calcsize('<4d')
_MARK = (1.25, -2.5, 5e300)  # stands for the place when looking for its bytes


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

    def serialise(self, snapshot: Snapshot, held: np.ndarray | None = None) -> bytes:
        """
        Return the CDR bytes of the frames of ``snapshot``, row by row of the pins.

        :param held: (rows, cols) bool, nodes to leave out: they have the frame of their grasp
        """
        pinned = snapshot.flags & FLAG_PINNED != 0
        if held is not None:
            pinned &= ~held
        pins = np.argwhere(pinned).tolist()
        if pins != self._pins:
            self._make_template(pins)
        time = stamp(snapshot.time)
        for (stamp_at, place_at), place in zip(self._fields, snapshot.positions[pinned].tolist()):
            _STAMP.pack_into(self._template, stamp_at, time.sec, time.nanosec)
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
