# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Names of a topic."""

from cloth_sim_ros.messages.topic import Topic
from sensor_msgs.msg import PointCloud2


def test_name_is_private_unless_global():
    """Two nodes would publish to one topic, or /clock under a node's name."""
    assert Topic('points', PointCloud2, depth=1).name == '~/points'
    assert Topic('clock', PointCloud2, depth=1, is_global=True).name == '/clock'


def test_full_name_holds_namespace():
    """A recording would name topics otherwise than the graph."""
    topic = Topic('inputs/push', PointCloud2, depth=1)
    assert topic.full_name('cloth_sim') == '/cloth_sim/inputs/push'
    assert topic.full_name('/left/cloth_sim') == '/left/cloth_sim/inputs/push'
    assert Topic('clock', PointCloud2, depth=1, is_global=True).full_name('/a/b') == '/clock'


def test_type_name_is_that_of_the_message():
    """A recording would name a type that is not there."""
    assert Topic('points', PointCloud2, depth=1).type_name == 'sensor_msgs/msg/PointCloud2'
