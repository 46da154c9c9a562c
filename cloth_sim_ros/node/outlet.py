# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where every message leaves the node, to its topic and into the recording."""

from collections.abc import Callable
from collections.abc import Collection
from collections.abc import Iterable
from typing import Any

from cloth_sim_ros.messages.topics import camera_topics
from cloth_sim_ros.messages.topics import topic_of
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.node.quick_publish import publish
from cloth_sim_ros.node.recording_session import RecordingSession
from rclpy._rclpy_pybind11 import InvalidHandle
from rclpy._rclpy_pybind11 import RCLError
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from rclpy.serialization import serialize_message


class Outlet:
    """
    Publish and record messages, serialised once, and only those that somebody reads.

    :param heard_here: the topics to which the node itself subscribes, once
    :param cameras: names of the cameras, which have topics of their own
    """

    def __init__(
            self, node: Node, recording: RecordingSession,
            heard_here: Collection[str] = (), cameras: Iterable[str] = ()) -> None:
        """Make the publishers of every topic but /clock, which may belong to somebody else."""
        self._heard_here = heard_here
        self._recording = recording
        self._node = node
        self._publishers: dict[str, Publisher] = {}
        for key in (*TOPICS, *camera_topics(cameras)):
            if key != 'clock':
                self.open_topic(key)

    def open_topic(self, key: str) -> None:
        """Make the publisher of the topic ``key``."""
        topic = topic_of(key)
        self._publishers[key] = self._node.create_publisher(
            topic.message, topic.name, _quality(topic))

    def close_topic(self, key: str) -> None:
        """Take the publisher of the topic ``key`` back."""
        self._node.destroy_publisher(self._publishers.pop(key))

    def is_open(self, key: str) -> bool:
        """Return whether the topic ``key`` has a publisher here."""
        return key in self._publishers

    def wanted(self, key: str, *, by_recording: bool = True) -> bool:
        """Return whether anybody reads the topic ``key`` now."""
        return (by_recording and self._recording.takes(key)) or self._subscribed(key)

    def send(
            self, key: str, serialise: Callable[[], bytes], sim_time: float, *,
            number: int = 0, epoch: int = 0) -> None:
        """
        Publish and record what ``serialise`` makes, if anybody reads it.

        :param sim_time: [s]
        :param number: of the recording that it belongs to; 0 for none
        :param epoch: stamp of simulated time 0 [ns]
        """
        # What is kept for late subscribers has readers that are not there yet.
        is_kept = topic_of(key).transient_local
        if is_kept or self.wanted(key, by_recording=number > 0):
            self.send_bytes(key, serialise(), sim_time, number=number, epoch=epoch)

    def send_bytes(
            self, key: str, data: bytes, sim_time: float, *, number: int = 0,
            to_topic: bool = True, epoch: int = 0) -> None:
        """Publish and record a serialised message, as ``send`` does."""
        if number and self._recording.takes(key):
            self._recording.write(key, data, sim_time, number, epoch)
        if to_topic and key in self._publishers:
            try:
                publish(self._publishers[key], data)
            except (InvalidHandle, RCLError):
                # Once ROS is shut down nothing is published, but the rest is still recorded.
                if self._node.context.ok():
                    raise

    def send_message(
            self, key: str, message: Any, sim_time: float, *, number: int = 0,
            epoch: int = 0) -> None:
        """Do the same with a ROS message object; for messages that are small."""
        self.send(key, lambda: serialize_message(message), sim_time, number=number, epoch=epoch)

    def _subscribed(self, key: str) -> bool:
        publisher = self._publishers.get(key)
        try:
            return publisher is not None and (
                publisher.get_subscription_count() > int(key in self._heard_here))
        except (InvalidHandle, RCLError):
            # The device thread asks, while the ROS thread may have closed the topic.
            return False


def _quality(topic: Any) -> QoSProfile:
    return QoSProfile(
        depth=topic.depth,
        reliability=ReliabilityPolicy.RELIABLE if topic.reliable
        else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if topic.transient_local
        else DurabilityPolicy.VOLATILE)
