# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

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
