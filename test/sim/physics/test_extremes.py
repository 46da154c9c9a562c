# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Extreme scenes in every mode: each runs finite, is refused, or stops at the last finite state.

The scenes, and what counts as nonsense, are those of ``cloth_sim study extremes``. ``-rP`` prints
a line a scene and mode.
"""


from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.extreme_scenes import EXTREMES
from cloth_sim_ros.study.extremes import run_extreme
import numpy as np
import pytest
from springs import SPRINGS

QUICK = [(name, mode) for name, extreme in EXTREMES.items() if not extreme.is_long
         for mode in extreme.modes]
# They take long, and other scenes or modes show the same: a size is refused in any mode.
TWINS = {
    ('k 0.001, m 1e-06, dt 0.1', 'adaptive'), ('8000 x 8000', 'constraint'),
    ('8000 x 8000', 'adaptive'), ('2 x 1000', 'constraint')}
LONG = [(name, mode) for name, extreme in EXTREMES.items() if extreme.is_long
        for mode in extreme.modes]


def _check(name, mode, context):
    extreme = EXTREMES[name]
    found = run_extreme(extreme, mode, context)
    print(f'| {name} | {mode} | {found.outcome} | {found.detail} |')
    assert found.outcome in extreme.expected
    assert not found.nonsense


@pytest.mark.parametrize(('name', 'mode'), [
    pytest.param(*each, marks=pytest.mark.long if each in TWINS else ()) for each in QUICK])
def test_an_extreme_scene_is_never_nonsense(name, mode, context):
    """A cloth would turn into NaN, gain energy from nothing or lose its edges without a word."""
    _check(name, mode, context)


@pytest.mark.long
@pytest.mark.parametrize(('name', 'mode'), LONG)
def test_a_long_extreme_scene_is_never_nonsense(name, mode, context):
    """The same, of a grid of stiffness, mass and dt, of random scenes and a million nodes."""
    _check(name, mode, context)


def test_a_scrambled_cloth_comes_back_to_its_limit(context, request):
    """Edges that are brought back to their limit throw the nodes about for ever."""
    simulation = Simulation(Scene({
        **SPRINGS, 'rows': 8, 'cols': 8, 'mode': 'adaptive'}), context=context)
    request.addfinalizer(simulation.close)
    positions = EXTREMES['scrambled'].start(
        simulation.scene.rest_positions(), np.random.default_rng(3))
    simulation.set_state(positions, np.zeros_like(positions))
    begin = simulation.measure()
    strains, energies = [], []
    for _ in range(15):
        simulation.advance(0.1)
        now = simulation.measure()
        strains.append(now.max_strain)
        energies.append(now.kinetic_energy / begin.elastic_energy)
    print(f'measured strain {begin.max_strain:.2g}, then {strains[0]:.3g} to {strains[-1]:.3g}; '
          f'kinetic energy over the elastic one at the start {energies[0]:.2g} to '
          f'{energies[-1]:.2g}')
    assert strains[-1] < 0.12
    assert energies[-1] < 0.01
