# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Switching the mode, by service and by parameter."""

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_ros.sim.scene_fields import MODES
import pytest
from rcl_interfaces.srv import GetParameters


def mode_parameter(cloth):
    """Return the value of the parameter mode."""
    return cloth.call(GetParameters, 'get_parameters', names=['mode']).values[0].string_value


def test_returns_the_previous_mode(cloth):
    """A caller could not go back to the mode it found."""
    response = cloth.call(SetMode, 'set_mode', mode='mass_spring')
    assert (response.success, response.previous_mode) == (True, 'mass_spring')


@pytest.mark.parametrize('mode, reason', [
    ('fluid', 'must be one of mass_spring, constraint, adaptive'), ('', 'must be one of')])
def test_refuses_an_unknown_mode(cloth, mode, reason):
    """A mistyped mode would be taken, or end the node."""
    response = cloth.call(SetMode, 'set_mode', mode=mode)
    assert (response.success, response.previous_mode) == (False, 'mass_spring')
    assert reason in response.message
    assert mode_parameter(cloth) == 'mass_spring'
    assert not cloth['inputs/mode']


@pytest.mark.parametrize('mode', MODES)
def test_takes_the_modes_that_the_state_names(cloth, mode):
    """A tool would offer modes that are refused, or the parameter would differ from the mode."""
    before = cloth.client.read_kept(ClothState, f'{cloth.name}/state')
    assert mode in before.available_modes
    response = cloth.call(SetMode, 'set_mode', mode=mode)
    assert (response.success, response.previous_mode) == (True, before.mode)
    after = cloth.client.read_kept(ClothState, f'{cloth.name}/state')
    assert after.mode == mode_parameter(cloth) == mode


@pytest.mark.parametrize('mode', MODES)
def test_the_parameter_does_what_the_service_does(cloth, mode):
    """`ros2 param set` would change the parameter and not the simulation."""
    before = cloth.client.read_kept(ClothState, f'{cloth.name}/state')
    cloth.clear()
    result = cloth.set_parameters(mode=mode)
    assert result.successful
    assert mode in before.available_modes
    assert mode_parameter(cloth) == mode
    cloth.wait_for('state', lambda state: state.mode == mode and not state.preparing)
