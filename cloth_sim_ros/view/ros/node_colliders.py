# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The colliders of a running node: their shapes from its parameters, their poses from /tf."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from cloth_sim_ros.messages.frame_names import collider_frame
from cloth_sim_ros.node.frame_tree import checked_pose
from cloth_sim_ros.node.frame_tree import read_transforms
from cloth_sim_ros.sim.colliders import Collider
from cloth_sim_ros.sim.colliders import colliders_of
from cloth_sim_ros.sim.colliders import fields_with_colliders
from cloth_sim_ros.sim.colliders import NAMES
from cloth_sim_ros.sim.errors import ClothSimError
from rcl_interfaces.srv import GetParameters
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
from tf2_msgs.msg import TFMessage


class NodeColliders:
    """
    Learns of the colliders of a node, in callbacks of ``node``.

    A node without colliders is asked once, and /tf is left alone.

    :param node: this program's own place in the graph
    :param name: of the node that has the colliders, with its namespace
    """

    def __init__(self, node: Node, name: str) -> None:
        """Ask for them."""
        self._node = node
        self._name = name
        self._client = node.create_client(GetParameters, f'{name}/get_parameters')
        self._by_frame: dict[str, Collider] = {}
        self._is_asked = False

    @property
    def present(self) -> tuple[Collider, ...]:
        """Return the colliders where they were last; none before it is known."""
        return tuple(self._by_frame.values())

    def ask(self) -> None:
        """Ask the node for its colliders, once, as soon as it answers requests."""
        if not self._is_asked and self._client.service_is_ready():
            self._is_asked = True
            self._get([NAMES], self._ask_for_each)

    def _ask_for_each(self, values: dict[str, Any]) -> None:
        if not values[NAMES]:
            return
        names = [
            field.name for field in fields_with_colliders(values)
            if field.name.startswith('colliders.')]
        self._get(names, self._begin)

    def _begin(self, values: dict[str, Any]) -> None:
        self._by_frame = {
            collider_frame(self._name, collider.name): collider
            for collider in colliders_of(values)}
        self._node.create_subscription(TFMessage, '/tf', self._take, 10, raw=True)

    def _take(self, data: bytes) -> None:
        try:
            for frame, _, _, place in read_transforms(data):
                if frame in self._by_frame:
                    pose = checked_pose(frame, place)
                    self._by_frame[frame] = replace(
                        self._by_frame[frame], position=pose.position,
                        orientation=pose.orientation)
        except ClothSimError:
            # The topic is everybody's.
            pass

    def _get(self, names: list[str], take: Callable[[dict[str, Any]], None]) -> None:
        def answer(future: Any) -> None:
            values = [parameter_value_to_python(value) for value in future.result().values]
            try:
                take(dict(zip(names, values)))
            except (ClothSimError, KeyError, TypeError):
                # Of a node of another version: its cloth is shown without them.
                self._by_frame = {}

        self._client.call_async(GetParameters.Request(names=names)).add_done_callback(answer)
