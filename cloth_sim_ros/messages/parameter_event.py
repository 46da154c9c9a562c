# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Parameters in CDR, without the unused bytes that the middleware leaves behind nested lists."""

from typing import Any

from cloth_sim_ros.messages.cdr_writer import CdrWriter
from cloth_sim_ros.sim.scene_fields import Field
from rcl_interfaces.msg import Parameter
from rcl_interfaces.msg import ParameterEvent
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


def serialise_parameter_event(event: ParameterEvent) -> bytes:
    """
    Return the CDR bytes of ``event``.

    Those of the middleware are longer than the message, and strict readers such as rosbags refuse
    them.
    """
    writer = CdrWriter()
    writer.put('i', event.stamp.sec)
    writer.put('I', event.stamp.nanosec)
    writer.put_string(event.node)
    for parameters in (
            event.new_parameters, event.changed_parameters, event.deleted_parameters):
        writer.put('I', len(parameters))
        for parameter in parameters:
            _put_parameter(writer, parameter)
    return writer.finish()


def _put_parameter(writer: CdrWriter, parameter: Parameter) -> None:
    value: ParameterValue = parameter.value
    writer.put_string(parameter.name)
    writer.put('B', value.type)
    writer.put('?', value.bool_value)
    writer.put('q', value.integer_value)
    writer.put('d', value.double_value)
    writer.put_string(value.string_value)
    _put_numbers(writer, 'B', [byte[0] for byte in value.byte_array_value])
    _put_numbers(writer, '?', value.bool_array_value)
    _put_numbers(writer, 'q', value.integer_array_value)
    _put_numbers(writer, 'd', value.double_array_value)
    writer.put('I', len(value.string_array_value))
    for text in value.string_array_value:
        writer.put_string(text)


def _put_numbers(writer: CdrWriter, code: str, numbers: Any) -> None:
    writer.put('I', len(numbers))
    # Of an empty list nothing follows, not even what would align its elements.
    if len(numbers):
        writer.put(code, *numbers)
