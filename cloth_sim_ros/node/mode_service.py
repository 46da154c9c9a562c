# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""~/set_mode: the same as setting the parameter mode."""

from cloth_sim_interfaces.srv import SetMode
from cloth_sim_ros.node.answer import serve_later
from cloth_sim_ros.node.mode_switch import ModeSwitch
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.simulation import Simulation
from rclpy.node import Node
from rclpy.parameter import Parameter


class ModeService:
    """Serve ~/set_mode by the parameter, so that both ways have the same effect and checks."""

    def __init__(self, node: Node, simulation: Simulation, switch: ModeSwitch) -> None:
        """Make the service."""
        self._node = node
        self._simulation = simulation
        self._switch = switch
        serve_later(node, SetMode, '~/set_mode', self._set_mode)

    async def _set_mode(self, request: SetMode.Request, response: SetMode.Response) -> str:
        response.previous_mode = self._simulation.mode
        result = self._node.set_parameters_atomically(
            [Parameter('mode', Parameter.Type.STRING, request.mode)])
        if not result.successful:
            raise ClothSimError(result.reason)
        done = self._switch.is_done(request.mode)
        if not request.wait and not done.done():
            return f'mode {request.mode} becomes active when it is ready; ~/state reports when'
        await done
        return f'mode {request.mode}, was {response.previous_mode}'
