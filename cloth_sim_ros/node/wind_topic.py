# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The wind, as a topic: ~/wind."""

from cloth_sim_ros.node.ignored_messages import check_frame
from cloth_sim_ros.node.ignored_messages import IgnoredMessages
from cloth_sim_ros.node.inputs import Inputs
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.simulation import Simulation
from geometry_msgs.msg import Vector3Stamped
from rclpy.node import Node

# A sensor or a model of the wind at 1 kHz fills it in the time of a few frames.
_DEPTH = 100


class WindTopic:
    """
    Listen to ~/wind: each message blows until the next one, from the end of the step under way.

    :param frame_id: of the cloth
    :param ignored: is given the messages that make no sense
    """

    def __init__(
            self, node: Node, simulation: Simulation, inputs: Inputs, frame_id: str,
            ignored: IgnoredMessages) -> None:
        """Make the subscription."""
        self._simulation = simulation
        self._inputs = inputs
        self._frame_id = frame_id
        self._ignored = ignored
        node.create_subscription(Vector3Stamped, '~/wind', self._on_message, _DEPTH)

    def _on_message(self, message: Vector3Stamped) -> None:
        velocity = (message.vector.x, message.vector.y, message.vector.z)
        try:
            check_frame(message.header.frame_id, self._frame_id)
            self._simulation.set_wind(velocity)
            self._inputs.wind(velocity)
        except ClothSimError as error:
            self._ignored.note('~/wind', error)
