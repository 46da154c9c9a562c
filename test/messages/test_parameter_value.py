# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A parameter's value as ROS types it."""

from cloth_sim_ros.messages.parameter_value import parameter_value
from cloth_sim_ros.sim.field import Field
import pytest
from rcl_interfaces.msg import ParameterType
from rclpy.parameter import parameter_value_to_python


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
