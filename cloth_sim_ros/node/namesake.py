# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A second node of the same name, which ROS does not prevent."""

from collections.abc import Callable

from rclpy.node import Node


class Namesake:
    """
    Watch for another node of this node's name, and warn once while there is one.

    :param service: one that only such a node offers, with ~
    :param warn: logs a sentence
    """

    def __init__(self, node: Node, service: str, warn: Callable[[str], None]) -> None:
        """Begin alone."""
        self._node = node
        self._service = node.resolve_service_name(service)
        self._warn = warn
        self._is_told = False

    def watch(self) -> None:
        """Look who is there."""
        is_there = self._node.count_services(self._service) > 1
        if is_there and not self._is_told:
            name = self._node.get_fully_qualified_name()
            self._warn(
                f'another node is also named {name}: both execute each request, the first '
                'response counts, and their topics are mixed; give one of them a namespace, such '
                'as by --ros-args -r __ns:=/left')
        self._is_told = is_there
