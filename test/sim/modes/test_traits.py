# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Properties of a mode that studies, recordings and accounts use instead of its name."""

import math

from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest
from springs import SPRINGS

# A limit of 1 % is reached within these steps.
SCENE = {
    'rows': 8, 'cols': 8, 'start.pose': 'horizontal', 'adaptive.threshold': 0.01, 'dt': 0.01}
STEPS = 40


@pytest.mark.parametrize('name', AVAILABLE)
def test_a_mode_without_memory_goes_on_from_a_state_alone(context, name: str):
    """A run that is made again from the middle of a recording would be held to its bits."""
    first, second = (Simulation(Scene({
        **SPRINGS, **SCENE, 'mode': name}), context=context) for _ in range(2))
    first.step(STEPS)
    reached = first.snapshot()
    second.set_state(reached.positions, reached.velocities)
    for simulation in (first, second):
        simulation.step(STEPS)
    same = all(
        np.array_equal(getattr(first.snapshot(), key), getattr(second.snapshot(), key))
        for key in ('positions', 'velocities'))
    assert same is not AVAILABLE[name].has_memory
    first.close()
    second.close()


@pytest.mark.parametrize('name', AVAILABLE)
def test_an_implicit_mode_has_no_stability_limit(context, name: str):
    """The account of energy would be that of another scheme, and a search for a limit endless."""
    simulation = Simulation(Scene({**SPRINGS, **SCENE, 'mode': name}), context=context)
    assert math.isinf(simulation.stability_limit) is AVAILABLE[name].is_implicit
    simulation.close()


@pytest.mark.parametrize(('name', 'values', 'expected'), [
    ('mass_spring', {}, 'springs'),
    ('adaptive', {}, 'limited'),
    ('constraint', {}, 'hard'),
    ('constraint', {'constraint.hard': [], 'constraint.springs': ['structural']}, 'springs'),
])
def test_edges_are_what_the_mode_makes_of_them(name: str, values: dict, expected: str):
    """A run would be compared with the reference of another cloth."""
    assert AVAILABLE[name].edge_model(Scene({
        **SPRINGS, **SCENE, **values, 'mode': name})) == expected
