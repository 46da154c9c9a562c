# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Finding out which node a bag is of."""

from pathlib import Path

from cloth_sim_ros.analysis.recorded_node import find_node
from cloth_sim_ros.analysis.recorded_node import TYPES
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.recording.bag_topic import BagTopic
from cloth_sim_ros.sim.errors import ClothSimError
import pytest
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import MessageDefinitionFormat

CLOUD = 'sensor_msgs/msg/PointCloud2'
STATS = 'cloth_sim_interfaces/msg/ClothStats'


def find(*topics):
    """Return the node of a bag with ``topics``, each a name and a type."""
    none = MessageDefinition(MessageDefinitionFormat.NONE, '')
    return find_node([BagTopic(*topic, (), 1, none) for topic in topics], Path('bag'))


def test_types_are_those_of_the_node():
    """A topic would be passed over as another program's."""
    assert TYPES == {
        key: topic.type_name for key, topic in TOPICS.items() if not topic.is_global}


def test_any_topic_of_ours_names_the_node():
    """A bag of a node with a namespace, or without points, would need --node."""
    assert find(('/cloth_sim/stats', STATS)) == '/cloth_sim'
    assert find(('/left/cloth/points', CLOUD), ('/rosout', 'a')) == '/left/cloth'
    assert find(('/a/inputs/push', 'cloth_sim_interfaces/msg/Push')) == '/a'


def test_points_of_other_programs_do_not_count_beside_ours():
    """A bag with a laser scanner in it would need --node."""
    assert find(('/laser/points', CLOUD), ('/a/stats', STATS), ('/a/points', CLOUD)) == '/a'


def test_other_types_do_not_count():
    """A bag of another program would be taken for a cloth."""
    with pytest.raises(ClothSimError, match='bag holds no frame of a cloth_sim node'):
        find(('/cloth_sim/points', 'std_msgs/msg/String'), ('/a/stats', CLOUD))


def test_several_nodes_are_not_mixed():
    """Two cloths in one bag would be read as one, or one of them without a word."""
    with pytest.raises(ClothSimError, match='several nodes .*/a, /b.*--node'):
        find(('/b/stats', STATS), ('/a/stats', STATS))
