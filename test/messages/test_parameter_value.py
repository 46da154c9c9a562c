# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
