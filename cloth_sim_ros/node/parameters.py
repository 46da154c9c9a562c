# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The node's parameters: declared from field tables, checked and set while it runs."""

from collections.abc import Callable
from collections.abc import Mapping
from collections.abc import Sequence
from typing import Any

from cloth_sim_ros.messages.inputs import parameter_value
from cloth_sim_ros.node.node_fields import check_together
from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.given_values import completed
from cloth_sim_ros.sim.model.named_fields import all_fields
from cloth_sim_ros.sim.model.scene_fields import Field
from cloth_sim_ros.sim.model.scene_fields import SCENE_FIELDS
from cloth_sim_ros.sim.scene import refuse_unknown
from rcl_interfaces.msg import FloatingPointRange
from rcl_interfaces.msg import IntegerRange
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterDescriptor
from rcl_interfaces.msg import ParameterType
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter

FIELDS = SCENE_FIELDS + NODE_FIELDS
FIELD_OF = {field.name: field for field in FIELDS}

# Parameters that rclpy itself declares or reads on every node.
_RCLPY_OWN = ('use_sim_time', 'start_type_description_service')
_RCLPY_OWN_PREFIX = 'qos_overrides.'


def declare_fields(node: Node, overrides: Mapping[str, Parameter]) -> dict[str, Any]:
    """
    Declare every field on ``node`` and return the checked values by name.

    :param overrides: what was given in parameter files and on the command line
    :raises ClothSimError: for an unknown name, a wrong type or a value outside its range;
        nothing is declared then
    """
    given = {
        name: plain_value(parameter) for name, parameter in overrides.items()
        if name not in _RCLPY_OWN and not name.startswith(_RCLPY_OWN_PREFIX)}
    fields = all_fields(given, FIELDS)
    refuse_unknown(given, fields)
    given = completed(given)
    values = {}
    for field in fields:
        value = given.get(field.name, field.default)
        # An empty list has no type in a parameter file: rcl reads it as "not set".
        values[field.name] = field.check(() if value is None and field.is_array else value)
    check_together(values)
    # rclpy takes an empty list for a list of bytes, so the type is declared first, the value set
    # then, and only then can the parameter become read-only.
    for field in fields:
        node.declare_parameter(
            field.name, _type(field, values[field.name]), ParameterDescriptor(),
            ignore_override=True)
    node.set_parameters_atomically(
        [as_parameter(field, values[field.name]) for field in fields])
    for field in fields:
        node.set_descriptor(field.name, descriptor(field, values[field.name]))
    return values


def as_parameter(field: Field, value: Any) -> Parameter:
    """Return the ROS parameter that holds a checked value of ``field``."""
    return Parameter.from_parameter_msg(
        ParameterMessage(name=field.name, value=parameter_value(field, value)))


def as_field_type(parameter: Parameter) -> Parameter:
    """Take whole numbers where a field holds numbers: `ros2 param set` types 2 as an integer."""
    whole = (Parameter.Type.INTEGER, Parameter.Type.INTEGER_ARRAY)
    field = FIELD_OF.get(parameter.name)
    if field is None or field.kind is not float or parameter.type_ not in whole:
        return parameter
    if field.is_array != (parameter.type_ == Parameter.Type.INTEGER_ARRAY):
        return parameter
    return as_parameter(field, plain_value(parameter))


def descriptor(field: Field, value: Any) -> ParameterDescriptor:
    """Describe ``field``, which has ``value``, for ROS tools."""
    low, high = field.low, field.high
    is_list = isinstance(value, tuple)
    unit = f' [{field.unit}]' if field.unit else ''
    constraints = f'one of {", ".join(field.choices)}' if field.choices else ''
    if low is not None and high is not None and is_list:
        constraints = f'each from {low:g} to {high:g}'
    described = ParameterDescriptor(
        name=field.name, type=_type(field, value).value,
        description=f'{field.text}{unit}', additional_constraints=constraints,
        read_only=not field.live)
    if low is not None and high is not None and field.kind is int:
        described.integer_range = [
            IntegerRange(from_value=int(low), to_value=int(high))]
    if low is not None and high is not None and field.kind is float and not is_list:
        described.floating_point_range = [
            FloatingPointRange(from_value=float(low), to_value=float(high))]
    return described


def plain_value(parameter: Parameter) -> Any:
    """Return the value of ``parameter`` with a list for any kind of array."""
    value = parameter.value
    return value if value is None or isinstance(value, (str, int, float)) else list(value)


def _type(field: Field, value: Any) -> Parameter.Type:
    return Parameter.Type(parameter_value(field, value).type)


# Requests to set parameters: what can't be is refused in this project's words, not rclpy's.

_LAST_TYPE = ParameterType.PARAMETER_STRING_ARRAY
MOST_AT_ONCE = 1000

_Callback = Callable[[Any, Any], Any]


def with_reasons(node: Node, kind: type, callback: _Callback) -> _Callback:
    """
    Return a service callback that refuses what rclpy refuses without a way out, or fails at.

    :param kind: of the service; other kinds than those that set parameters are left alone
    :param callback: rclpy's own, given what is not refused
    """
    def set_each(request: Any, response: Any) -> Any:
        for parameter in request.parameters[:MOST_AT_ONCE]:
            reason = _refusal(node, parameter)
            if reason:
                response.results.append(SetParametersResult(successful=False, reason=reason))
            else:
                callback(SetParameters.Request(parameters=[parameter]), response)
        left = len(request.parameters) - MOST_AT_ONCE
        response.results += max(left, 0) * [
            SetParametersResult(successful=False, reason=_too_many(request))]
        return response

    def set_all(request: Any, response: Any) -> Any:
        if not request.parameters:
            response.result = SetParametersResult(
                successful=False, reason='the request sets no parameter: give one or more')
            return response
        reasons = (_refusal(node, parameter) for parameter in request.parameters)
        reason = (
            _too_many(request) if len(request.parameters) > MOST_AT_ONCE
            else next(filter(None, reasons), ''))
        if reason:
            response.result = SetParametersResult(successful=False, reason=reason)
            return response
        return callback(request, response)

    return {SetParameters: set_each, SetParametersAtomically: set_all}.get(kind, callback)


def _refusal(node: Node, message: ParameterMessage) -> str:
    """Return why ``message`` can't be set; empty when it may be."""
    try:
        _check(node, message)
    except ClothSimError as error:
        return str(error)
    return ''


def _check(node: Node, message: ParameterMessage) -> None:
    name, kind = message.name, message.value.type
    field = FIELD_OF.get(name)
    if field is None and not node.has_parameter(name):
        refuse_unknown([name], FIELDS)
    if not 0 < kind <= _LAST_TYPE:
        raise ClothSimError(
            f'the value of {name} has the type {kind}, which does not exist: use one of '
            f'rcl_interfaces/msg/ParameterType from 1 to {_LAST_TYPE}')
    if field is None:
        _check_type(name, Parameter.Type(kind), node.get_parameter(name).type_)
        return
    if not field.live:
        raise ClothSimError(
            f'{name} is read-only while the node runs: restart the node with -p {name}:=VALUE, or '
            'with a parameter file')
    field.check(plain_value(as_field_type(Parameter.from_parameter_msg(message))))


def _check_type(name: str, given: Parameter.Type, own: Parameter.Type) -> None:
    if given is not own:
        raise ClothSimError(
            f'{name} has the type {_in_words(own)}, got {_in_words(given)}: give a value of its '
            'type')


def _in_words(kind: Parameter.Type) -> str:
    return kind.name.lower().replace('_', ' ')


def _too_many(request: Any) -> str:
    return (
        f'a request can set at most {MOST_AT_ONCE} parameters, this one has '
        f'{len(request.parameters)}: send several')


class LiveParameters:
    """
    Check and apply changes of parameters while the node runs.

    :param values: parameter values by name, kept up to date here
    :param ask_mode: asks for another mode; a ClothSimError is the reason of the rejection
    :param changed: called with the parameters after each accepted change
    """

    def __init__(
            self, node: Node, values: dict[str, Any], *, ask_mode: Callable[[str], None],
            changed: Callable[[Sequence[Parameter]], None]) -> None:
        """Register with ``node``."""
        self._values = values
        self._ask_mode = ask_mode
        self._changed = changed
        node.add_pre_set_parameters_callback(_with_field_types)
        node.add_on_set_parameters_callback(self._on_set)
        node.add_post_set_parameters_callback(self._after_set)

    def _on_set(self, parameters: list[Parameter]) -> SetParametersResult:
        try:
            checked = {
                parameter.name: FIELD_OF[parameter.name].check(plain_value(parameter))
                for parameter in parameters if parameter.name in FIELD_OF}
            check_together({**self._values, **checked})
            # Last, because it is the only one that can still fail, and nothing may change then.
            if 'mode' in checked:
                self._ask_mode(checked['mode'])
        except ClothSimError as error:
            return SetParametersResult(successful=False, reason=str(error))
        if self._values['time.source'] == 'ros' and any(
                parameter.name == 'use_sim_time' and parameter.value is False
                for parameter in parameters):
            return SetParametersResult(successful=False, reason=(
                'use_sim_time stays true with time.source: ros, which follows /clock: restart the '
                'node with time.source: own'))
        self._values.update(checked)
        return SetParametersResult(successful=True)

    def _after_set(self, parameters: list[Parameter]) -> None:
        own = [parameter for parameter in parameters if parameter.name in FIELD_OF]
        if own:
            self._changed(own)


def _with_field_types(parameters: list[Parameter]) -> list[Parameter]:
    return [as_field_type(parameter) for parameter in parameters]
