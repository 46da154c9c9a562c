# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
