# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The topic /clock, for a recording that has none."""

from builtin_interfaces.msg import Time
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.playback.header_stamp import has_header
from cloth_sim_ros.playback.header_stamp import header_stamp
from cloth_sim_ros.playback.played_topic import PATIENCE
from cloth_sim_ros.playback.played_topic import PlayedTopic
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock


class SimulatedClock:
    """
    Publish the stamp of each frame ahead of it, as a node with publish.clock does.

    ``topic`` is what it is published on, which waits for its readers as the others do.

    :param patience: for a reader to take what it has been sent [s]
    """

    def __init__(self, node: Node, patience: float = PATIENCE) -> None:
        """Make the publisher."""
        topic = TOPICS['clock']
        self.topic = PlayedTopic(
            node, topic.name, topic.message, QoSProfile(depth=topic.depth),
            patience=patience)
        self._latest: Time | None = None

    def read(self, message_class: type, data: bytes) -> None:
        """Take up the stamp of a serialised message of the cloth, if it has one."""
        if not has_header(message_class):
            return
        stamp = header_stamp(data)
        if stamp != self._latest:
            self._latest = stamp
            self.topic.publish(serialize_message(Clock(clock=stamp)))
