# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Requests to set parameters: what can't be is refused in this project's words, not rclpy's."""

from collections.abc import Callable
from typing import Any

from cloth_sim_ros.node.parameters import as_field_type
from cloth_sim_ros.node.parameters import FIELD_OF
from cloth_sim_ros.node.parameters import FIELDS
from cloth_sim_ros.node.parameters import plain_value
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import refuse_unknown
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterType
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter

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
