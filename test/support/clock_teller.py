# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A foreign /clock, and where the frames are by the stamps of a node."""

from collections.abc import Iterable
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from builtin_interfaces.msg import Time
from cloth_sim_ros.messages.stamp import NANOSECONDS
from cloth_sim_ros.node.frame_tree import checked_pose
from cloth_sim_ros.node.frame_tree import FrameTree
from cloth_sim_ros.node.frame_tree import Sample
from cloth_sim_ros.sim.model.pose import Pose
from graph_client import GraphClient
import pytest
from rclpy.qos import QoSProfile
from rosgraph_msgs.msg import Clock


def in_nanoseconds(stamp: Time) -> int:
    """Return a ROS time as a number."""
    return stamp.sec * NANOSECONDS + stamp.nanosec


def ros_time(time: int) -> Time:
    """Return ``time`` [ns] as ROS has it."""
    sec, nanosec = divmod(time, NANOSECONDS)
    return Time(sec=sec, nanosec=nanosec)


class ClockTeller:
    """
    Publishes /clock; a context manager.

    :ivar now: the latest time [ns]
    """

    def __init__(self, client: GraphClient, begin: int) -> None:
        """Make the publisher; ``begin`` [ns] is the first time that is told."""
        self._client = client
        self._publisher = client.node.create_publisher(Clock, '/clock', QoSProfile(depth=1))
        self.now = begin

    def __enter__(self) -> 'ClockTeller':
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Take the publisher back."""
        self._client.node.destroy_publisher(self._publisher)

    def tell(self, now: int | None = None) -> None:
        """Publish once that it is ``now`` [ns]; None repeats the latest."""
        self.now = self.now if now is None else now
        self._publisher.publish(Clock(clock=ros_time(self.now)))

    def tell_until(self, condition: Any, what: str, now: int | None = None) -> Any:
        """Publish the same time until ``condition`` returns something, and return that."""
        self.now = self.now if now is None else now

        def told() -> Any:
            self.tell()
            return condition()

        return self._client.spin_until(told, what)

    def run(self, seconds: float, interval: float, factor: float) -> None:
        """
        Let ``seconds`` of this clock pass.

        :param interval: between two messages, in this clock [s]
        :param factor: of this clock to the wall clock
        """
        begin, count = self.now, round(seconds / interval)
        for number in range(1, count + 1):
            self.tell(begin + round(number * interval * NANOSECONDS))
            self._client.spin_for(interval / factor)


class SeenFrames:
    """
    Where frames are by the rules of the node and, where ROS has it, by compiled tf2 as well.

    :param messages: TFMessages, as a listener of tf2 keeps them
    """

    def __init__(self, messages: Iterable[Any]) -> None:
        """Take the messages."""
        self._tree = FrameTree(lambda name: None, 'publish it')
        # Wheels of ROS have no tf2; a sourced ROS has.
        self._buffer = import_module('tf2_py').BufferCore() if find_spec('tf2_py') else None
        for each in (each for message in messages for each in message.transforms):
            place, turn = each.transform.translation, each.transform.rotation
            pose = checked_pose(each.child_frame_id, (
                place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w))
            self._tree.add(each.child_frame_id, Sample(
                in_nanoseconds(each.header.stamp), each.header.frame_id, pose), is_fixed=False)
            if self._buffer is not None:
                self._buffer.set_transform(each, 'a test')

    def pose(self, frame: str, to: str, time: int | None) -> Pose:
        """Return where ``frame`` is at ``time`` [ns], None for the latest, seen from ``to``."""
        pose = self._tree.pose(frame, to, time)
        if self._buffer is not None:
            place = self._buffer.lookup_transform_core(
                to, frame, ros_time(time or 0)).transform.translation
            assert pose.position == pytest.approx((place.x, place.y, place.z), abs=1e-9)
        return pose
