# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A cloth that is caught gains nothing by it, and one that hangs at its limit does not sink."""

from cloth_sim_ros.study.random_limits import random_scene
from force_tremor import SCENES
import numpy as np
import pytest

# Undamped, without shear, hung by its upper corners: it falls until its upper row catches it all
# but straight, where tensions are many times the weight. The push comes later than is looked.
_CAUGHT = {**random_scene(20), 'pushes.start': [1.0]}
# Steps until it has swung back; a limit catches it sooner than springs do.
LOOKED_AT = {'adaptive': 30}
# Springs so soft that the limit carries the cloth.
_HANGING = SCENES['15 x 4 nodes, limit 2 %']


def largest_gain(energies):
    """Return by how much energy was at most above what it had been before [J]."""
    return float(np.max(np.array(energies) - np.minimum.accumulate(energies)))


def test_a_caught_cloth_is_not_thrown(simulate, within, mode):
    """What brings edges back to their length throws the cloth, by most of what it fell with."""
    simulation = simulate({**_CAUGHT, 'mode': mode})
    energies, kinetic = [], []
    for _ in range(LOOKED_AT.get(mode, 60)):
        simulation.step()
        now = simulation.measure()
        energies.append(now.total_energy)
        kinetic.append(now.kinetic_energy)
    within(f'energy that came back after a catch over the most kinetic, {mode}',
           largest_gain(energies) / max(kinetic), 0.3)


@pytest.mark.parametrize('seconds', [2, pytest.param(3, marks=pytest.mark.long)])
def test_a_cloth_at_its_limit_does_not_sink(simulate, within, seconds):
    """Edges that tremble at their limit lose energy, and would be ever longer."""
    simulation, strains = simulate(_HANGING), []
    for _ in range(seconds):
        simulation.advance(1.0)
        strains.append(simulation.measure().max_strain / _HANGING['adaptive.threshold'])
    within(f'strain over its limit at 1 to {seconds} s', max(strains), 1.15)


def test_a_push_that_no_limit_holds_is_reported(simulate):
    """Edges would be stretched to many times their length without a word."""
    simulation = simulate(
        {'mode': 'adaptive', 'rows': 8, 'cols': 8, 'adaptive.threshold': 0.1})
    simulation.push((0.0, 0.0, 1e6), duration=0.1, region='sphere', center=(0.0, 0.0, 1.0),
                    radius=0.15)
    simulation.step()
    snapshot = simulation.snapshot()
    assert snapshot.finite and snapshot.max_strain > 1.0
    assert not snapshot.lengths_are_held
    assert snapshot.stability_margin > 1.0


def test_a_push_of_a_hundred_times_the_weight_is_held(simulate, within):
    """A push stretches edges to many times their length before the limit takes notice."""
    simulation = simulate(
        {'mode': 'adaptive', 'rows': 8, 'cols': 8, 'adaptive.threshold': 0.1})
    weight = 64 * simulation.scene.node_mass * 9.81
    simulation.push(
        (0.0, 0.0, 100.0 * weight), duration=0.1, region='sphere', center=(0.0, 0.0, 1.0),
        radius=0.15)
    strains = []
    for _ in range(30):
        simulation.step()
        strains.append(simulation.measure().max_strain)
    within('strain at the limit of 0.1 under 100 times the weight', max(strains), 0.3)
