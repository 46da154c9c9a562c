# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Who publishes /clock."""

from cloth_under_test import PAUSED
from node_process import NodeProcess
from rosgraph_msgs.msg import Clock


def test_backs_off_from_another_publisher(client, tmp_path):
    """Two clocks would pull the time of every node of the graph back and forth."""
    node = client.node
    with NodeProcess(tmp_path, {**PAUSED, 'publish.clock': True}, '-r', '__ns:=/clock_test'):
        client.spin_until(lambda: node.count_publishers('/clock') == 1, 'the node has /clock')
        clock = client.watch(Clock, '/clock')
        client.spin_until(lambda: clock.messages, 'a paused node publishes the time')
        other = node.create_publisher(Clock, '/clock', 10)
        client.spin_until(lambda: node.count_publishers('/clock') == 1, 'the node backs off')
        node.destroy_publisher(other)
        client.spin_until(lambda: node.count_publishers('/clock') == 1, 'the node is back')


def test_does_not_publish_unless_asked(cloth):
    """Every node with use_sim_time would follow the cloth."""
    cloth.wait_for('diagnostics')
    assert cloth.client.node.count_publishers('/clock') == 0
