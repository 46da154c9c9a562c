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
