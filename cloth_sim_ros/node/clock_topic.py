# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Whether this node may publish /clock: never beside another publisher."""

from cloth_sim_ros.node.outlet import Outlet
from rclpy.node import Node


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
