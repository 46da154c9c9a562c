# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Parameters as bytes."""

from cloth_sim_ros.messages.inputs import parameter_value
from cloth_sim_ros.messages.inputs import parameters_message
from cloth_sim_ros.messages.inputs import serialise_parameter_event
from cloth_sim_ros.node.parameters import FIELDS
from cloth_sim_ros.sim.model.scene_fields import Field
import pytest
from rcl_interfaces.msg import Parameter
from rcl_interfaces.msg import ParameterEvent
from rcl_interfaces.msg import ParameterType
from rcl_interfaces.msg import ParameterValue
from rclpy.parameter import parameter_value_to_python
from rclpy.serialization import deserialize_message
from rosbags.typesys import get_typestore
from rosbags.typesys import Stores

EVERYTHING = ParameterEvent(
    node='/a/node', deleted_parameters=[Parameter(name='gone')],
    changed_parameters=[Parameter(name='all', value=ParameterValue(
        type=9, bool_value=True, integer_value=-2**40, double_value=0.1, string_value='väl',
        byte_array_value=[b'\x07', b'\xff'], bool_array_value=[True, False, True],
        integer_array_value=[1, -5], double_array_value=[1e-300, 2.5],
        string_array_value=['', 'two words']))])


@pytest.mark.parametrize(('kind', 'value', 'type_number'), [
    (bool, True, ParameterType.PARAMETER_BOOL),
    (int, 3, ParameterType.PARAMETER_INTEGER),
    (float, 0.5, ParameterType.PARAMETER_DOUBLE),
    (str, 'a', ParameterType.PARAMETER_STRING),
    (bool, (True, False), ParameterType.PARAMETER_BOOL_ARRAY),
    (int, (3, 4), ParameterType.PARAMETER_INTEGER_ARRAY),
    (float, (), ParameterType.PARAMETER_DOUBLE_ARRAY),
    (float, (0.5, 1.0), ParameterType.PARAMETER_DOUBLE_ARRAY),
    (str, (), ParameterType.PARAMETER_STRING_ARRAY),
    (str, ('a', 'b'), ParameterType.PARAMETER_STRING_ARRAY),
])
def test_values_keep_type_and_content(kind, value, type_number):
    """A parameter, above all an empty list, would come back as another type."""
    is_array = isinstance(value, tuple)
    message = parameter_value(Field('a', kind, value, '', is_array=is_array), value)
    assert message.type == type_number
    content = parameter_value_to_python(message)
    assert (tuple(content) if is_array else content) == value


def all_of_a_node():
    """Return all parameters with their defaults."""
    return parameters_message({field.name: field.default for field in FIELDS}, FIELDS, 1.5, 'n')


def test_reads_as_it_was():
    """ROS would get other parameters."""
    for event in (EVERYTHING, ParameterEvent(), all_of_a_node()):
        assert deserialize_message(serialise_parameter_event(event), ParameterEvent) == event


def test_has_no_byte_too_many():
    """Strict readers of recordings would refuse the parameters."""
    store = get_typestore(Stores.ROS2_JAZZY)
    for event in (EVERYTHING, all_of_a_node()):
        data = serialise_parameter_event(event)
        decoded = store.deserialize_cdr(data, 'rcl_interfaces/msg/ParameterEvent')
        assert bytes(store.serialize_cdr(decoded, decoded.__msgtype__)) == data
