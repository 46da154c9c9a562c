# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Declare the scene's and the node's parameters from their field tables."""

from collections.abc import Mapping
from typing import Any

from cloth_sim_ros.messages.inputs import parameter_value
from cloth_sim_ros.node.node_fields import check_together
from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.sim.colliders import fields_with_colliders
from cloth_sim_ros.sim.given_values import completed
from cloth_sim_ros.sim.scene import refuse_unknown
from cloth_sim_ros.sim.scene_fields import Field
from cloth_sim_ros.sim.scene_fields import SCENE_FIELDS
from rcl_interfaces.msg import FloatingPointRange
from rcl_interfaces.msg import IntegerRange
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterDescriptor
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
    fields = fields_with_colliders(given, FIELDS)
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
