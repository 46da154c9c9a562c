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

from typing import Any

from cloth_sim_ros.sim.field import Field
from rcl_interfaces.msg import ParameterType
from rcl_interfaces.msg import ParameterValue

_SLOTS = {
    (bool, False): (ParameterType.PARAMETER_BOOL, 'bool_value'),
    (int, False): (ParameterType.PARAMETER_INTEGER, 'integer_value'),
    (float, False): (ParameterType.PARAMETER_DOUBLE, 'double_value'),
    (str, False): (ParameterType.PARAMETER_STRING, 'string_value'),
    (bool, True): (ParameterType.PARAMETER_BOOL_ARRAY, 'bool_array_value'),
    (int, True): (ParameterType.PARAMETER_INTEGER_ARRAY, 'integer_array_value'),
    (float, True): (ParameterType.PARAMETER_DOUBLE_ARRAY, 'double_array_value'),
    (str, True): (ParameterType.PARAMETER_STRING_ARRAY, 'string_array_value'),
}


def parameter_value(field: Field, value: Any) -> ParameterValue:
    """Return ``value`` with the type of ``field``: an empty list alone does not tell its type."""
    is_list = field.is_array or (field.is_pair and isinstance(value, tuple))
    kind, slot = _SLOTS[field.kind, is_list]
    content = [field.kind(part) for part in value] if is_list else field.kind(value)
    return ParameterValue(type=kind, **{slot: content})
