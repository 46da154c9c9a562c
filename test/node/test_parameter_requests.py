# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Requests to set parameters that rclpy fails at, or refuses without a way out."""

import pytest
from rcl_interfaces.msg import Parameter
from rcl_interfaces.msg import ParameterValue
from rcl_interfaces.srv import GetParameters
from rcl_interfaces.srv import SetParameters
from rcl_interfaces.srv import SetParametersAtomically

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
