# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The table of topics."""

from cloth_sim_ros.messages.topics import Topic
from cloth_sim_ros.messages.topics import TOPICS
import pytest
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


@pytest.mark.parametrize(('key', 'type_name', 'depth', 'transient_local'), [
    ('points', 'sensor_msgs/msg/PointCloud2', 10, False),
    ('markers', 'visualization_msgs/msg/MarkerArray', 1, False),
    ('topology', 'shape_msgs/msg/Mesh', 1, True),
    ('stats', 'cloth_sim_interfaces/msg/ClothStats', 10, False),
    ('pins/wrenches', 'geometry_msgs/msg/WrenchStamped', 1024, False),
    ('grasps/wrenches', 'geometry_msgs/msg/WrenchStamped', 100, False),
    ('colliders/wrenches', 'geometry_msgs/msg/WrenchStamped', 100, False),
    ('state', 'cloth_sim_interfaces/msg/ClothState', 1, True),
    ('tf', 'tf2_msgs/msg/TFMessage', 100, False),
    ('clock', 'rosgraph_msgs/msg/Clock', 10, False),
    ('diagnostics', 'diagnostic_msgs/msg/DiagnosticArray', 10, False),
])
def test_topics_are_as_documented(key, type_name, depth, transient_local):
    """Subscribers written against the documentation would not connect."""
    topic = TOPICS[key]
    assert (topic.type_name, topic.depth, topic.transient_local, topic.reliable) == (
        type_name, depth, transient_local, True)


def test_all_inputs_are_recorded():
    """A run could not be simulated again from its recording."""
    inputs = {key for key in TOPICS if key.startswith('inputs/')}
    assert inputs == {
        'inputs/push', 'inputs/pin', 'inputs/pin_target', 'inputs/grasp', 'inputs/grasp_target',
        'inputs/collider_target', 'inputs/wind', 'inputs/mode', 'inputs/command',
        'inputs/parameters', 'inputs/time_base'}
    assert all(TOPICS[key].recorded for key in inputs)
    assert TOPICS['topology'].recorded and TOPICS['clock'].recorded
    assert TOPICS['pins/wrenches'].recorded and TOPICS['tf'].recorded


def test_only_shared_topics_are_global():
    """Topics of two nodes would run into each other."""
    assert {key for key, topic in TOPICS.items() if topic.is_global} == {
        'clock', 'diagnostics', 'tf'}
