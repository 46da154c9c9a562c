# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A change of the mode while running keeps the state, and with it the energy."""

from contextlib import closing
from itertools import permutations

from cloth_sim_ros.reference.cloth import elastic_energy
from cloth_sim_ros.reference.edges import spring_sets
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
from pushed_scenes import paper_scene
from pushed_scenes import unit_scene
import pytest

PAPER, UNIT = paper_scene(5.0, 0.005, node_mass=0.3), unit_scene(12, 5.0, 0.005)
PAIRS = list(permutations(AVAILABLE, 2))
# Many of its edges are at their limit then.
LIMITED = ('adaptive', 'mass_spring')


@pytest.mark.parametrize(('before', 'after', 'values'), [
    *(pytest.param(*pair, PAPER, id=f'{"-".join(pair)}-paper') for pair in PAIRS),
    pytest.param(*LIMITED, UNIT, id=f'{"-".join(LIMITED)}-unit'),
    *(pytest.param(*pair, UNIT, id=f'{"-".join(pair)}-unit', marks=pytest.mark.long)
      for pair in PAIRS if pair != LIMITED)])
def test_a_switch_keeps_the_state_and_its_energy(context, before, after, values):
    """The switch moves nodes, or a mode continues with an outdated state."""
    with closing(Simulation(Scene({**values, 'mode': before}), context=context)) as simulation:
        simulation.advance(0.6)
        # There, back after a while, and there again: a mode must not remember the first time.
        for name in (after, before, after):
            state = simulation.snapshot()
            simulation.set_mode(name)
            same = simulation.snapshot()
            assert same.state_sha256 == state.state_sha256
            assert same.kinetic_energy == state.kinetic_energy
            assert same.gravitational_energy == state.gravitational_energy
            assert same.active_constraints == 0
            simulation.step()
            moved = simulation.snapshot()
            scale = state.kinetic_energy + _of_all_springs(state, simulation.scene)
            change = abs(_total(moved, simulation.scene) - _total(state, simulation.scene)) / scale
            print(f'measured {change:.1e} of 0.01 allowed: energy, one step of {name} later')
            assert change <= 0.01
            simulation.advance(0.05)


def _total(state: Snapshot, scene: Scene) -> float:
    """Return the energy with that of all springs [J], hard or not: no switch changes that."""
    return state.kinetic_energy + state.gravitational_energy + _of_all_springs(state, scene)


def _of_all_springs(state: Snapshot, scene: Scene) -> float:
    return elastic_energy(spring_sets(scene), state.positions.astype(float))
