# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The node's parameters: declared from field tables, checked and set while it runs."""

from cloth_sim_ros.node.parameters import FIELDS
from cloth_under_test import PAUSED
import pytest
from rcl_interfaces.msg import Parameter
from rcl_interfaces.msg import ParameterType
from rcl_interfaces.msg import ParameterValue
from rcl_interfaces.srv import DescribeParameters
from rcl_interfaces.srv import GetParameters
from rcl_interfaces.srv import ListParameters
from rcl_interfaces.srv import SetParameters
from rcl_interfaces.srv import SetParametersAtomically

NAMES = [field.name for field in FIELDS]
TYPES = {
    (bool, False): ParameterType.PARAMETER_BOOL,
    (int, False): ParameterType.PARAMETER_INTEGER,
    (float, False): ParameterType.PARAMETER_DOUBLE,
    (str, False): ParameterType.PARAMETER_STRING,
    (int, True): ParameterType.PARAMETER_INTEGER_ARRAY,
    (float, True): ParameterType.PARAMETER_DOUBLE_ARRAY,
    (str, True): ParameterType.PARAMETER_STRING_ARRAY,
}
VALUE_SLOTS = {
    ParameterType.PARAMETER_BOOL: 'bool_value',
    ParameterType.PARAMETER_INTEGER: 'integer_value',
    ParameterType.PARAMETER_DOUBLE: 'double_value',
    ParameterType.PARAMETER_STRING: 'string_value',
    ParameterType.PARAMETER_INTEGER_ARRAY: 'integer_array_value',
    ParameterType.PARAMETER_DOUBLE_ARRAY: 'double_array_value',
    ParameterType.PARAMETER_STRING_ARRAY: 'string_array_value',
}


def test_all_fields_are_declared(cloth):
    """A value of the field tables could not be seen from outside."""
    listed = cloth.call(ListParameters, 'list_parameters').result.names
    assert set(NAMES) <= set(listed)


def test_values_are_those_of_the_file_and_the_tables(cloth):
    """A parameter would tell another value than the one in use; empty lists would be lost."""
    values = cloth.call(GetParameters, 'get_parameters', names=NAMES).values
    for field, value in zip(FIELDS, values, strict=True):
        expected = PAUSED.get(field.name, field.default)
        assert value.type == TYPES[field.kind, field.is_array], field.name
        told = getattr(value, VALUE_SLOTS[value.type])
        assert (tuple(told) if field.is_array else told) == expected, field.name


def test_descriptions_carry_text_unit_and_range(cloth):
    """A user of a parameter tool would have to guess what a value means."""
    described = cloth.call(DescribeParameters, 'describe_parameters', names=NAMES).descriptors
    for field, descriptor in zip(FIELDS, described, strict=True):
        assert descriptor.description.startswith(field.text)
        assert not field.unit or f'[{field.unit}]' in descriptor.description
        assert descriptor.read_only == (not field.live), field.name
        assert descriptor.type == TYPES[field.kind, field.is_array], field.name
        ranges = [*descriptor.integer_range, *descriptor.floating_point_range]
        if field.low is not None and not field.is_array:
            assert (ranges[0].from_value, ranges[0].to_value) == (field.low, field.high)
        assert all(choice in descriptor.additional_constraints for choice in field.choices)


@pytest.mark.parametrize('name, value', [
    ('rows', 9), ('dt', 0.001), ('gravity', [0.0, 0.0, 0.0]), ('pins', ['all']),
    ('recording.directory', '/'), ('publish.rate', 10.0)])
def test_what_the_run_depends_on_is_read_only(cloth, name, value):
    """A parameter would seem changed although the simulation goes on as before."""
    result = cloth.set_parameters(**{name: value})
    assert not result.successful
    assert 'read-only' in result.reason


# Requests to set parameters that rclpy fails at, or refuses without a way out.

GOOD = Parameter(name='clicked_point.radius', value=ParameterValue(type=3, double_value=0.5))
BAD = {
    'no such type': (Parameter(
        name='real_time_factor', value=ParameterValue(type=99)), 'type 99, which does not exist'),
    'unset': (Parameter(name='real_time_factor'), 'type 0, which does not exist'),
    'unset, of rclpy': (Parameter(name='use_sim_time'), 'type 0, which does not exist'),
    'another type, of rclpy': (Parameter(
        name='use_sim_time', value=ParameterValue(type=7)), 'the type bool, got integer array'),
    'no name': (Parameter(value=ParameterValue(type=3)), 'there is no parameter'),
    'typing error': (Parameter(
        name='real_time_facto', value=ParameterValue(type=3)), 'did you mean real_time_factor?'),
    'bytes': (Parameter(name='mode', value=ParameterValue(
        type=5, byte_array_value=[b'a'])), 'got [b'),
    'read-only': (Parameter(
        name='rows', value=ParameterValue(type=2, integer_value=9)), '-p rows:=VALUE'),
}


def radius(cloth):
    """Return the parameter that GOOD sets."""
    [value] = cloth.call(GetParameters, 'get_parameters', names=[GOOD.name]).values
    return value.double_value


@pytest.mark.parametrize('case', BAD)
def test_each_gets_its_own_reason(cloth, case):
    """One bad parameter would end the node, or leave the good ones beside it without an answer."""
    bad, reason = BAD[case]
    cloth.set_parameters(clicked_point__radius=0.25)
    results = cloth.call(SetParameters, 'set_parameters', parameters=[bad, GOOD, bad]).results
    assert [result.successful for result in results] == [False, True, False]
    assert reason in results[0].reason
    assert radius(cloth) == 0.5


@pytest.mark.parametrize('case', BAD)
def test_set_at_once_all_or_none_are_set(cloth, case):
    """The good part of a refused request would be set."""
    bad, reason = BAD[case]
    cloth.set_parameters(clicked_point__radius=0.25)
    result = cloth.call(
        SetParametersAtomically, 'set_parameters_atomically', parameters=[GOOD, bad]).result
    assert not result.successful and reason in result.reason
    assert radius(cloth) == 0.25


def test_a_request_sets_a_bounded_number(cloth):
    """One request could keep the node busy for minutes."""
    bad, _ = BAD['unset']
    results = cloth.call(SetParameters, 'set_parameters', parameters=[bad] * 1200).results
    assert len(results) == 1200
    assert 'does not exist' in results[999].reason and 'send several' in results[1000].reason
    result = cloth.call(
        SetParametersAtomically, 'set_parameters_atomically', parameters=[GOOD] * 1200).result
    assert not result.successful and 'send several' in result.reason
