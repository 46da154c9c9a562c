# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""~/set_pin: hold a node where it is, or let it go."""

from cloth_sim_interfaces.srv import SetPin
from cloth_sim_ros.node.answer import answer
from cloth_sim_ros.node.inputs import Inputs
from cloth_sim_ros.sim.simulation import Simulation
from rclpy.node import Node


class PinService:
    """Serve ~/set_pin."""

    def __init__(self, node: Node, simulation: Simulation, inputs: Inputs) -> None:
        """Make the service."""
        self._simulation = simulation
        self._inputs = inputs
        node.create_service(SetPin, '~/set_pin', answer(self._set_pin))

    def _set_pin(self, request: SetPin.Request, response: SetPin.Response) -> str:
        row, col = request.row, request.col
        if request.use_point:
            # Fields that are not set are 0 in ROS: that distance means the usual one.
            near = self._simulation.nearest_node(
                (request.point.x, request.point.y, request.point.z),
                request.max_distance or None)
            row, col, response.distance = near.row, near.col, near.distance
        response.row, response.col = row, col
        if request.release:
            self._simulation.release(row, col)
        else:
            self._simulation.pin(row, col)
        self._inputs.pin(row, col, not request.release)
        place = f', {response.distance:.3f} m from the point' if request.use_point else ''
        return f'node ({row}, {col}) is {"free" if request.release else "pinned"}{place}'
