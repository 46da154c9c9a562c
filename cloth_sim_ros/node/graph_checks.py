# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What else is in the ROS graph: a second node of the same name, or another /clock."""

from collections.abc import Callable

from cloth_sim_ros.node.outlet import Outlet
from rclpy.node import Node

# How long a first message on /clock may take before that is said [s].
PATIENCE = 5


class ClockTopic:
    """
    Hold the publisher of /clock while nobody else has one.

    :param enabled: False never publishes
    """

    def __init__(self, node: Node, outlet: Outlet, enabled: bool) -> None:
        """Wait for the first watch: other publishers need time to be discovered."""
        self._node = node
        self._outlet = outlet
        self._enabled = enabled
        self._warned = False

    def watch(self) -> None:
        """Take /clock when it is free, leave it when another node publishes it; now and then."""
        if not self._enabled:
            return
        held = self._outlet.is_open('clock')
        others = self._node.count_publishers('/clock') - int(held)
        if others == 0 and not held:
            self._outlet.open_topic('clock')
            self._warned = False
        if others > 0 and held:
            self._outlet.close_topic('clock')
        if others > 0 and not self._warned:
            self._node.get_logger().warning(
                '/clock has another publisher, so this node does not publish it: stop the '
                'other one, or set publish.clock: false')
            self._warned = True


class ClockSource:
    """
    Watch whether /clock comes, from one node, where it is needed; warn once of each.

    :param is_followed: whether the time of the node is that of /clock
    :param is_known: returns whether a message has come
    :param warn: logs a sentence
    """

    def __init__(
            self, node: Node, outlet: Outlet, *, is_followed: bool, is_known: Callable[[], bool],
            warn: Callable[[str], None]) -> None:
        """Begin to wait."""
        self._node = node
        self._outlet = outlet
        self._is_followed = is_followed
        self._is_known = is_known
        self._warn = warn
        self._watches = 0
        self._told = ''

    @property
    def others(self) -> int:
        """Get the number of publishers of /clock besides this node."""
        return self._node.count_publishers('/clock') - int(self._outlet.is_open('clock'))

    @property
    def problem(self) -> str:
        """Return what is wrong; empty for nothing."""
        others = self.others
        if not self._is_followed:
            is_used = self._node.get_parameter('use_sim_time').value
            return (
                '/clock comes from another node, and this one has use_sim_time and its own time: '
                'set time.source: ros to follow it, or use_sim_time: false'
                if is_used and others else '')
        if others > 1:
            return (
                f'/clock has {others} publishers and the cloth can follow one: stop the others')
        if not self._is_known() and self._watches > PATIENCE:
            return (
                'no message has come on /clock, which time.source: ros waits for: start what '
                'publishes it, or restart the node with time.source: own')
        if self._is_known() and not others:
            return (
                '/clock has no publisher any more, and the cloth stands still until it comes '
                'again: start what publishes it, or restart the node with time.source: own')
        return ''

    def watch(self) -> None:
        """Look; once a second."""
        self._watches += 1
        problem = self.problem
        if problem and problem != self._told:
            self._warn(problem)
        self._told = problem


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
