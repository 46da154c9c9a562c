# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is given in any frame of tf, in the frame of the cloth: listen to /tf and /tf_static."""

from dataclasses import dataclass
from typing import Any

from cloth_sim_ros.messages.stamp import NANOSECONDS
from cloth_sim_ros.node.frame_history import Sample
from cloth_sim_ros.node.frame_tree import FrameTree
from cloth_sim_ros.node.own_frames import OwnFrames
from cloth_sim_ros.node.refusals import IgnoredMessages
from cloth_sim_ros.node.tf_messages import checked_pose
from cloth_sim_ros.node.tf_messages import read_transforms
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.pose import Pose
from cloth_sim_ros.sim.pose import product
from cloth_sim_ros.sim.pose import Quaternion
from cloth_sim_ros.sim.pose import turned
from cloth_sim_ros.sim.pose import Vector
from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription
from tf2_msgs.msg import TFMessage

# A robot at 1 kHz fills it between two calls of take_waiting.
_DEPTH = 1000


class _Unserved(CallbackGroup):
    """
    Keeps the executor from subscriptions.

    To wake for a message takes it ten times longer than to read that, and it takes one a turn.
    """

    def can_execute(self, entity: Any) -> bool:
        """Return False: nothing is ever to be called."""
        return False

    def beginning_execution(self, entity: Any) -> bool:
        """Return False likewise."""
        return False

    def ending_execution(self, entity: Any) -> None:
        """Do nothing."""


@dataclass(frozen=True)
class Given:
    """
    Turns numbers of a frame into those of the frame of the cloth.

    :param pose: of the frame; None for the frame of the cloth itself
    """

    pose: Pose | None = None

    def point(self, point: Any) -> Vector:
        """Return a message with x, y and z, a place, as numbers [m]."""
        x, y, z = self.vector(point)
        if self.pose is None:
            return x, y, z
        px, py, pz = self.pose.position
        return px + x, py + y, pz + z

    def vector(self, vector: Any) -> Vector:
        """Return a message with x, y and z, a force or a velocity, as numbers: turned alone."""
        parts = vector.x, vector.y, vector.z
        return parts if self.pose is None else turned(parts, self.pose.orientation)

    def orientation(self, orientation: Any) -> Quaternion:
        """Return a quaternion message as numbers x y z w; its length stays."""
        parts = orientation.x, orientation.y, orientation.z, orientation.w
        return parts if self.pose is None else product(self.pose.orientation, parts)


class InputFrames:
    """
    Know the frames, and say what a header means.

    :param own: the frames of the node itself
    :param frame_id: of the cloth
    :param listens: False to know no others than these
    :param ignored: is given transforms that make no sense
    """

    def __init__(
            self, node: Node, own: OwnFrames, frame_id: str, ignored: IgnoredMessages, *,
            listens: bool) -> None:
        """Make the subscriptions."""
        self._own = own
        self._frame_id = frame_id
        self._ignored = ignored
        self._tree = FrameTree(
            own.history, 'publish it on /tf or /tf_static' if listens
            else 'start the node with tf.listen: true')
        self._subscriptions: list[tuple[Subscription, bool]] = []
        if listens:
            self._listen(node, '/tf_static', is_fixed=True)
            self._listen(node, '/tf', is_fixed=False)

    def given(self, header: Any) -> Given:
        """
        Return what turns the numbers of a message with ``header`` into those of the cloth's frame.

        :raises ClothSimError: when its frame is not known at its stamp
        """
        if header.frame_id in ('', self._frame_id):
            return Given()
        self.take_waiting()
        time = header.stamp.sec * NANOSECONDS + header.stamp.nanosec
        return Given(self._tree.pose(header.frame_id, self._frame_id, time or None))

    def forget(self) -> None:
        """Forget where frames were: the time has gone back. Fixed ones stay."""
        self.take_waiting()
        self._own.forget()
        self._tree.forget_moving()

    def take_waiting(self) -> None:
        """Take what has come on /tf and /tf_static; call it now and then, before it piles up."""
        for subscription, is_fixed in self._subscriptions:
            for _ in range(_DEPTH):
                with subscription.handle:
                    taken = subscription.handle.take_message(TFMessage, True)
                if taken is None:
                    break
                self._keep(subscription.topic_name, taken[0], is_fixed)

    def _listen(self, node: Node, topic: str, *, is_fixed: bool) -> None:
        quality = QoSProfile(
            depth=_DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL if is_fixed
            else DurabilityPolicy.VOLATILE)
        self._subscriptions.append((node.create_subscription(
            TFMessage, topic, _never_called, quality, callback_group=_Unserved(), raw=True),
            is_fixed))

    def _keep(self, topic: str, data: bytes, is_fixed: bool) -> None:
        try:
            for frame, time, parent, place in read_transforms(data):
                # What the node has sent itself, or a recording of it, comes in messages of its
                # own; where these frames are, it knows.
                if self._own.owns(frame):
                    return
                try:
                    sample = Sample(time, parent, checked_pose(frame, place))
                    self._tree.add(frame, sample, is_fixed=is_fixed)
                except ClothSimError as error:
                    self._ignored.note(topic, error)
        except ClothSimError as error:
            self._ignored.note(topic, error)


def _never_called(_: bytes) -> None:
    """Stand for the callback that each subscription has to have."""
