# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The topics of a bag and their messages, decoded by the definitions that the bag holds."""

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.recording.bag_messages import BagTopic
from cloth_sim_ros.recording.bag_messages import MessageDecoder
from cloth_sim_ros.recording.bag_messages import MOST_ELEMENTS
from cloth_sim_ros.recording.bag_messages import parse_definition
from cloth_sim_ros.recording.bag_messages import RawMessage
from cloth_sim_ros.recording.message_definition import message_definition
from cloth_sim_ros.sim.errors import ClothSimError
from hostile_mcap import DEFINITIONS
import pytest
from rcl_interfaces.msg import Parameter
from rcl_interfaces.msg import ParameterEvent
from rclpy.serialization import serialize_message
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import MessageDefinitionFormat
from std_msgs.msg import String

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


# Decoding by the definitions of a bag, or without them.

STATS = 'cloth_sim_interfaces/msg/ClothStats'


def raw(message, type_name):
    """Return ``message`` as a bag would hold it."""
    return RawMessage('/topic', type_name, 0, serialize_message(message))


def topic(type_name, text, kind=MessageDefinitionFormat.MSG):
    """Return a topic whose type is defined by ``text``."""
    return BagTopic('/topic', type_name, (), 1, MessageDefinition(kind, text))


def test_missing_definitions_come_from_the_packages():
    """Bags of older ROS, which hold no definitions, could not be read."""
    decoder = MessageDecoder([topic(STATS, '', MessageDefinitionFormat.NONE)])
    read = decoder.decode(raw(ClothStats(steps=7, max_strain=0.25, solver_reached=True), STATS))
    assert (read.steps, read.max_strain, read.solver_reached) == (7, 0.25, True)
    assert decoder.decode(raw(String(data='text'), 'std_msgs/msg/String')).data == 'text'


def test_the_definition_of_the_bag_counts():
    """A bag of another version would be read with the fields of this one."""
    decoder = MessageDecoder([topic('std_msgs/msg/String', 'string other')])
    assert decoder.decode(raw(String(data='text'), 'std_msgs/msg/String')).other == 'text'


def test_definitions_in_idl_are_read():
    """A bag of a publisher whose type is defined in IDL could not be read."""
    text = 'module std_msgs { module msg { struct String { string other; }; }; };'
    for definition in (text, f'{"=" * 80}\nIDL: std_msgs/msg/String\n{text}'):
        decoder = MessageDecoder([
            topic('std_msgs/msg/String', definition, MessageDefinitionFormat.IDL)])
        assert decoder.decode(raw(String(data='text'), 'std_msgs/msg/String')).other == 'text'


@pytest.mark.parametrize('type_name, data', [
    ('std_msgs/msg/String', b''), ('std_msgs/msg/String', b'\x00\x01\x00\x00\xff\xff\xff\xff'),
    (STATS, b'\x00\x01\x00\x00\x01'), ('other/msg/Unknown', b'\x00\x01\x00\x00'), ('', b'text')])
def test_what_makes_no_sense_is_refused(type_name, data):
    """A damaged message, or one of another program, would end in a traceback."""
    with pytest.raises(ClothSimError, match=f'/topic is not a valid {type_name} .*: give'):
        MessageDecoder([]).decode(RawMessage('/topic', type_name, 0, data))


def test_bytes_that_nothing_fills_are_passed_over():
    """Recorded parameters could not be read: the middleware makes them longer than they are."""
    event = ParameterEvent(node='/a', new_parameters=[Parameter(name='b')] * 3)
    kind = 'rcl_interfaces/msg/ParameterEvent'
    data = serialize_message(event) + b'\x07' * 64
    read = MessageDecoder([]).decode(RawMessage('/topic', kind, 0, data))
    assert [parameter.name for parameter in read.new_parameters] == ['b'] * 3
