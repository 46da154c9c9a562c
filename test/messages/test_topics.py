# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The table of topics."""

from cloth_sim_ros.messages.topics import TOPICS
import pytest


@pytest.mark.parametrize(('key', 'type_name', 'depth', 'transient_local'), [
    ('points', 'sensor_msgs/msg/PointCloud2', 10, False),
    ('markers', 'visualization_msgs/msg/MarkerArray', 1, False),
    ('topology', 'shape_msgs/msg/Mesh', 1, True),
    ('stats', 'cloth_sim_interfaces/msg/ClothStats', 10, False),
    ('pins/wrenches', 'geometry_msgs/msg/WrenchStamped', 1024, False),
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
        'inputs/push', 'inputs/pin', 'inputs/pin_target', 'inputs/wind', 'inputs/mode',
        'inputs/command', 'inputs/parameters'}
    assert all(TOPICS[key].recorded for key in inputs)
    assert TOPICS['topology'].recorded and TOPICS['clock'].recorded
    assert TOPICS['pins/wrenches'].recorded and TOPICS['tf'].recorded


def test_only_topics_that_all_nodes_have_in_common_are_global():
    """Topics of two nodes would run into each other."""
    assert {key for key, topic in TOPICS.items() if topic.is_global} == {
        'clock', 'diagnostics', 'tf'}
