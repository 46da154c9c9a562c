# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a recording says about a message type."""

from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.recording.message_definition import message_definition
from cloth_sim_ros.recording.message_definition import MOST_ELEMENTS
from cloth_sim_ros.recording.message_definition import parse_definition
from cloth_sim_ros.recording.message_definition import type_hash
from hostile_mcap import DEFINITIONS
import pytest
import rclpy
from rclpy.context import Context
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import MessageDefinitionFormat
from rosbags.typesys import get_types_from_msg
from rosbags.typesys import get_typestore
from rosbags.typesys import Stores

RULE = '=' * 80
MSG, IDL = MessageDefinitionFormat.MSG, MessageDefinitionFormat.IDL
POSE = """
module geometry_msgs { module msg {
  module Pose_Constants { const long LIMIT = -3; const string NAME = "a (b) << c"; };
  typedef double double__36[36];
  @verbatim (language="comment", text= "a pose (of (something)) | more")
  struct Pose {
    @verbatim (language="comment", text= "x \\"y\\"") @unit (value="m")
    double__36 covariance;
    sequence<string<10>, 5> names; // of (its) parts | these
    sequence<double> values; /* one << two */
  };
}; };
"""


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
    info, = graph.get_publishers_info_by_topic(publisher.topic_name)
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


@pytest.mark.parametrize('name', [
    'cloth_sim_interfaces/msg/ClothState', 'sensor_msgs/msg/PointCloud2',
    'visualization_msgs/msg/MarkerArray', 'rcl_interfaces/msg/ParameterEvent',
    'geometry_msgs/msg/PoseWithCovarianceStamped'])
def test_definitions_of_real_types_are_parsed(name):
    """A recording could not be read at all."""
    assert name in parse_definition(MessageDefinition(MSG, message_definition(name)), name)


def test_an_idl_with_all_that_ros_writes_is_parsed():
    """A recording of a publisher with IDL types could not be read."""
    types = parse_definition(MessageDefinition(IDL, POSE), 'geometry_msgs/msg/Pose')
    assert [name for name, _ in types['geometry_msgs/msg/Pose'][1]] == [
        'covariance', 'names', 'values']


@pytest.mark.parametrize('name', [
    'a long array of words', 'a long array of messages', 'doubled 60 times', 'a long text',
    'idl parentheses', 'idl sequences', 'idl shifts', 'idl operators', 'idl modules',
    'idl annotations'])
def test_what_would_take_forever_is_refused(name):
    """A few bytes would keep every verb until it is killed."""
    text = DEFINITIONS[name]
    kind = IDL if text.startswith('IDL ') else MSG
    with pytest.raises(ValueError, match='its definition has|its arrays|is an array of length 0'):
        parse_definition(MessageDefinition(kind, text.removeprefix('IDL ')), 'a/msg/A')


def test_arrays_of_numbers_may_be_as_long_as_they_like():
    """A message with an image of fixed size could not be read."""
    long = MessageDefinition(MSG, f'uint8[{10**9}] a\nstring[{MOST_ELEMENTS}] b\n')
    assert 'a/msg/A' in parse_definition(long, 'a/msg/A')
