# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The player's place in the ROS graph."""

import time

from cloth_sim_ros.playback.play_clock import PlayClock
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_srvs.srv import SetBool

NODE_NAME = 'cloth_sim_player'


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
