# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The wind, as a topic: ~/wind."""

from cloth_sim_ros.node.ignored_messages import IgnoredMessages
from cloth_sim_ros.node.input_frames import InputFrames
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

    :param frames: says what headers mean
    :param ignored: is given the messages that make no sense
    """

    def __init__(
            self, node: Node, simulation: Simulation, inputs: Inputs, frames: InputFrames,
            ignored: IgnoredMessages) -> None:
        """Make the subscription."""
        self._simulation = simulation
        self._inputs = inputs
        self._frames = frames
        self._ignored = ignored
        node.create_subscription(Vector3Stamped, '~/wind', self._on_message, _DEPTH)

    def _on_message(self, message: Vector3Stamped) -> None:
        try:
            velocity = self._frames.given(message.header).vector(message.vector)
            self._simulation.set_wind(velocity)
            self._inputs.wind(velocity)
        except ClothSimError as error:
            self._ignored.note('~/wind', error)
