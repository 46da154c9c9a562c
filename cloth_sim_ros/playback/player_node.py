# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The player's place in the ROS graph, with /clock where a recording has none."""

import time

from builtin_interfaces.msg import Time
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.playback.play_clock import PlayClock
from cloth_sim_ros.playback.played_topic import has_header
from cloth_sim_ros.playback.played_topic import header_stamp
from cloth_sim_ros.playback.played_topic import PATIENCE
from cloth_sim_ros.playback.played_topic import PlayedTopic
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock
from std_srvs.srv import SetBool

NODE_NAME = 'cloth_sim_player'


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


class PlayerNode:
    """
    A node with the service ~/pause; a context manager.

    :param clock: that ~/pause stops and lets go on, by time.monotonic
    """

    def __init__(self, clock: PlayClock) -> None:
        """Join the graph."""
        self._clock = clock
        # In a context of its own, rclpy leaves the signals alone.
        self._context = Context()
        rclpy.init(args=[], context=self._context)
        self.node = Node(
            NODE_NAME, context=self._context, start_parameter_services=False,
            enable_rosout=False)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)

    def __enter__(self) -> 'PlayerNode':
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Leave the graph."""
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.try_shutdown(context=self._context)

    def offer_pause(self) -> None:
        """Offer ~/pause: last, so that who finds it has found the topics before."""
        self.node.create_service(SetBool, '~/pause', self._pause)

    def spin(self, seconds: float) -> None:
        """Wait up to ``seconds`` for a call of the service, and answer it."""
        self._executor.spin_once(timeout_sec=seconds)

    def _pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        if request.data:
            self._clock.pause(time.monotonic())
        else:
            self._clock.resume(time.monotonic())
        response.success = True
        response.message = 'paused' if request.data else 'playing'
        return response
