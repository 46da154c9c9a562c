# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a recording says about a message type."""

from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.recording.message_definition import message_definition
from cloth_sim_ros.recording.message_definition import type_hash
import pytest
import rclpy
from rclpy.context import Context
from rosbags.typesys import get_types_from_msg
from rosbags.typesys import get_typestore
from rosbags.typesys import Stores

RULE = '=' * 80


def test_definition_holds_all_parts_once():
    """A reader without the package could not decode the message."""
    text = message_definition('cloth_sim_interfaces/msg/Push')
    own, *parts = text.split(f'\n{RULE}\n')
    assert own.startswith('# A force on the cloth')
    names = [part.splitlines()[0] for part in parts]
    assert names == [
        'MSG: geometry_msgs/Point', 'MSG: geometry_msgs/Vector3', 'MSG: std_msgs/Header',
        'MSG: builtin_interfaces/Time']


def test_parts_of_the_same_package_are_found():
    """A reader could not decode types named without their package."""
    text = message_definition('visualization_msgs/msg/MarkerArray')
    for part in ('visualization_msgs/Marker', 'visualization_msgs/MeshFile',
                 'sensor_msgs/CompressedImage', 'builtin_interfaces/Duration'):
        assert text.count(f'{RULE}\nMSG: {part}\n') == 1


@pytest.fixture(scope='module')
def graph():
    """Return a node of its own context."""
    context = Context()
    rclpy.init(context=context)
    node = rclpy.create_node('hashes', context=context)
    yield node
    node.destroy_node()
    rclpy.shutdown(context=context)


@pytest.mark.parametrize('key', list(TOPICS))
def test_hash_is_that_of_the_publisher(graph, key):
    """Players would take the recorded type for another version of it."""
    topic = TOPICS[key]
    publisher = graph.create_publisher(topic.message, topic.name, topic.depth)
    # Nodes of other tests may be there yet, and publish on /tf and /diagnostics too.
    info, = (each for each in graph.get_publishers_info_by_topic(publisher.topic_name)
             if each.node_name == graph.get_name())
    assert info.topic_type == topic.type_name
    assert type_hash(topic.type_name) == str(info.topic_type_hash)


@pytest.mark.parametrize('key', list(TOPICS))
def test_hash_is_that_of_the_definition(key):
    """The text recorded would define another type than the one sent."""
    name = TOPICS[key].type_name
    store = get_typestore(Stores.EMPTY)
    text = message_definition(name)
    store.register(get_types_from_msg(text, name))
    assert store.hash_rihs01(name) == type_hash(name)
