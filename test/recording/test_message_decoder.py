# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Decoding by the definitions of a bag, or without them."""

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.recording.bag_topic import BagTopic
from cloth_sim_ros.recording.bag_topic import RawMessage
from cloth_sim_ros.recording.message_decoder import MessageDecoder
from cloth_sim_ros.sim.errors import ClothSimError
import pytest
from rcl_interfaces.msg import Parameter
from rcl_interfaces.msg import ParameterEvent
from rclpy.serialization import serialize_message
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import MessageDefinitionFormat
from std_msgs.msg import String

STATS = 'cloth_sim_interfaces/msg/ClothStats'


def raw(message, type_name):
    """Return ``message`` as a bag would hold it."""
    return RawMessage('/topic', type_name, 0, serialize_message(message))


def topic(type_name, text, kind=MessageDefinitionFormat.MSG):
    """Return a topic whose type is defined by ``text``."""
    return BagTopic('/topic', type_name, (), 1, MessageDefinition(kind, text))


def test_types_without_a_definition_are_those_of_the_packages():
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
