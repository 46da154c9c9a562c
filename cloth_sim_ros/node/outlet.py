# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where every message leaves the node: to its topic and into the recording, as the same bytes."""

from collections.abc import Callable
from collections.abc import Collection
from typing import Any

from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.node.recording_session import RecordingSession
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
    """

    def __init__(
            self, node: Node, recording: RecordingSession,
            heard_here: Collection[str] = ()) -> None:
        """Make the publishers of every topic but /clock, which may belong to somebody else."""
        self._heard_here = heard_here
        self._recording = recording
        self._node = node
        self._publishers: dict[str, Publisher] = {}
        for key in TOPICS:
            if key != 'clock':
                self.open_topic(key)

    def open_topic(self, key: str) -> None:
        """Make the publisher of the topic ``key``."""
        topic = TOPICS[key]
        self._publishers[key] = self._node.create_publisher(
            topic.message, topic.name, _quality(topic))

    def close_topic(self, key: str) -> None:
        """Take the publisher of the topic ``key`` back."""
        self._node.destroy_publisher(self._publishers.pop(key))

    def is_open(self, key: str) -> bool:
        """Tell whether the topic ``key`` has a publisher here."""
        return key in self._publishers

    def wanted(self, key: str, *, by_recording: bool = True) -> bool:
        """Tell whether anybody reads the topic ``key`` now."""
        return (by_recording and self._recorded(key)) or self._subscribed(key)

    def send(
            self, key: str, serialise: Callable[[], bytes], sim_time: float, *,
            to_recording: bool = True) -> None:
        """
        Publish and record what ``serialise`` makes, if anybody reads it.

        :param sim_time: [s]
        :param to_recording: False for what has been sent before
        """
        # What is kept for late subscribers has readers that are not there yet.
        is_kept = TOPICS[key].transient_local
        if not is_kept and not self.wanted(key, by_recording=to_recording):
            return
        data = serialise()
        # The recording first: a publish fails when the node is being shut down.
        if to_recording and self._recorded(key):
            self._recording.write(key, data, sim_time)
        if key in self._publishers:
            self._publishers[key].publish(data)

    def send_message(
            self, key: str, message: Any, sim_time: float, *, to_recording: bool = True) -> None:
        """Do the same with a ROS message object; for messages that are small."""
        self.send(
            key, lambda: serialize_message(message), sim_time, to_recording=to_recording)

    def _recorded(self, key: str) -> bool:
        return self._recording.active and TOPICS[key].recorded

    def _subscribed(self, key: str) -> bool:
        publisher = self._publishers.get(key)
        return publisher is not None and (
            publisher.get_subscription_count() > int(key in self._heard_here))


def _quality(topic: Any) -> QoSProfile:
    return QoSProfile(
        depth=topic.depth,
        reliability=ReliabilityPolicy.RELIABLE if topic.reliable
        else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if topic.transient_local
        else DurabilityPolicy.VOLATILE)
