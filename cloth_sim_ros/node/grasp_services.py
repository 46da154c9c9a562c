# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Nodes that are grasped and released from outside: ~/grasp and ~/release."""

from collections.abc import Callable

from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import Release
from cloth_sim_ros.node.answer import answer
from cloth_sim_ros.node.input_frames import InputFrames
from cloth_sim_ros.node.inputs import Inputs
from cloth_sim_ros.sim.handling import InputListener
from cloth_sim_ros.sim.simulation import Simulation
from rclpy.node import Node


class GraspServices:
    """
    Serve ~/grasp and ~/release.

    :param frames: says what headers mean
    :param changed: called when there are other grasps than before
    """

    def __init__(
            self, node: Node, simulation: Simulation, inputs: Inputs, frames: InputFrames,
            changed: Callable[[], None]) -> None:
        """Make the services."""
        self._simulation = simulation
        self._inputs = inputs
        self._frames = frames
        self._changed = changed
        node.create_service(Grasp, '~/grasp', answer(self._on_grasp))
        node.create_service(Release, '~/release', answer(self._on_release))

    def _on_grasp(self, request: Grasp.Request, response: Grasp.Response) -> str:
        given = self._frames.given(request.header)
        grasp = self._simulation.grasp(
            request.name, given.point(request.pose.position),
            given.orientation(request.pose.orientation), radius=request.radius,
            count=request.count, max_force=request.max_force)
        self._inputs.grasp(grasp)
        self._changed()
        response.nodes = len(grasp.nodes)
        return f'grasp {grasp.name} holds {response.nodes} nodes'

    def _on_release(self, request: Release.Request, response: Release.Response) -> str:
        names = [request.name] if request.name else [
            grasp.name for grasp in self._simulation.grasps]
        for name in names:
            grasp = self._simulation.release_grasp(name)
            self._inputs.grasp_release(name, False)
            response.nodes += len(grasp.nodes)
        self._changed()
        what = f'grasp {request.name}' if request.name else f'{len(names)} grasps'
        return f'{response.nodes} nodes of {what} are free'


class LostGrasps(InputListener):
    """
    Hear of grasps that the cloth has pulled too hard at; of all else their services tell.

    :param changed: called when there are other grasps than before
    """

    def __init__(
            self, inputs: Inputs, warn: Callable[[str], object],
            changed: Callable[[], None]) -> None:
        """Wait for one."""
        self._inputs = inputs
        self._warn = warn
        self._changed = changed

    def grasp_release(self, name: str, by_force: bool) -> None:
        """Warn, and tell."""
        if not by_force:
            return
        self._warn(
            f'grasp {name} has lost the cloth, which pulled harder than its max_force: grasp '
            'again, and move it more slowly or give it a higher max_force')
        self._inputs.grasp_release(name, True)
        self._changed()
