# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Changing parameters while the node runs."""

from cloth_sim_interfaces.srv import Step
import pytest
from rcl_interfaces.srv import GetParameters

BAD = {
    'negative': ({'real_time_factor': -1.0}, 'outside its range: give a value from 0 to'),
    'no number': ({'real_time_factor': float('nan')}, 'must be finite'),
    'infinite': ({'real_time_factor': float('inf')}, 'must be finite'),
    'slower than a timer can wait': ({'real_time_factor': 1e-12}, 'to stand still, pause'),
    'word for a number': ({'real_time_factor': 'fast'}, 'must be a number'),
    'number for a switch': ({'publish.points': 1}, 'must be true or false'),
    'no number in a list': ({'clicked_point.force': [0.0, 0.0, float('nan')]}, 'must be finite'),
    'too few components': ({'clicked_point.force': [1.0]}, 'needs 3 components, got 1'),
    'no radius': ({'clicked_point.radius': 0.0}, 'outside its range'),
    'unknown mode': ({'mode': 'fluid'}, 'must be one of'),
    'good beside bad': (
        {'publish.points': False, 'clicked_point.force': [1.0]}, 'needs 3 components'),
    'unknown name': ({'no.such.name': 1.0}, 'there is no parameter no.such.name'),
}
LIVE = [
    'mode', 'real_time_factor', 'publish.points', 'clicked_point.force', 'clicked_point.radius']


def live_values(cloth):
    """Return the values of some live parameters."""
    return cloth.call(GetParameters, 'get_parameters', names=LIVE).values


@pytest.mark.parametrize('case', BAD)
def test_rejects_with_a_reason_and_changes_nothing(cloth, case):
    """A bad value would be taken, or one part of a rejected change."""
    change, reason = BAD[case]
    before = live_values(cloth)
    result = cloth.set_parameters(**change)
    assert not result.successful
    assert reason in result.reason and result.reason
    assert live_values(cloth) == before
    cloth.call(Step, 'step', steps=1)
    cloth.frame(1)
    assert not cloth['inputs/parameters']


def test_takes_whole_numbers_for_numbers(cloth):
    """`ros2 param set /cloth_sim real_time_factor 2` would be refused."""
    assert cloth.set_parameters(real_time_factor=2, clicked_point__force=[0, 0, 2]).successful
    _, factor, _, force, _ = live_values(cloth)
    assert factor.double_value == 2.0
    assert list(force.double_array_value) == [0.0, 0.0, 2.0]


def test_changes_are_told_as_inputs(cloth):
    """A recording would not know that a parameter was changed while it ran."""
    cloth.call(Step, 'step', steps=4)
    cloth.clear()
    assert cloth.set_parameters(clicked_point__radius=0.5, real_time_factor=3.0).successful
    told = cloth.wait_for('inputs/parameters')
    assert {entry.name: entry.value.double_value for entry in told.changed_parameters} == {
        'clicked_point.radius': 0.5, 'real_time_factor': 3.0}
    assert told.node == cloth.name
    assert told.stamp.nanosec == 20_000_000
