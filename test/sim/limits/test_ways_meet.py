# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The ways to hold a limit agree where they have to, and can take turns."""

from contextlib import closing

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.energy_account import EnergyAccount
from measured import within
import numpy as np
import pytest
from springs import SPRINGS

SCHEMES = ('list', 'lattice', 'whole')
SIDE = 0.5
SCENE = {
    **SPRINGS, 'mode': 'adaptive', 'rows': 8, 'cols': 8, 'width': SIDE, 'height': SIDE,
    'areal_density': 0.2, 'start.pose': 'hanging', 'pins': ['top_left', 'top_right'],
    'adaptive.threshold': 0.02, 'stiffness.structural': 3.0, 'stiffness.shear': 1.0,
    'stiffness.bend': 0.3, 'damping.structural': 0.02, 'damping.shear': 0.02,
    'damping.bend': 0.003, 'air.density': 0.0, 'dt': 0.005, 'solver.tolerance': 1e-4}
# Weight of the cloth times its side [J].
WEIGHT = 0.2 * SIDE**2 * 9.81 * SIDE


def start(context, scheme, **values):
    """Return a simulation in ``scheme`` that ends with a ``with``."""
    scene = Scene({**SCENE, **values, 'adaptive.scheme': scheme})
    return closing(Simulation(scene, context=context))


@pytest.mark.long
def test_all_come_to_the_same_rest(context):
    """A limit would be another one in each, or store what the others do not."""
    drapes = {}
    for scheme in SCHEMES:
        with start(context, scheme) as simulation:
            simulation.advance(6.0)
            drapes[scheme] = simulation.snapshot()
            print(f'{scheme}: {drapes[scheme].kinetic_energy:.1e} J kinetic, '
                  f'{drapes[scheme].active_constraints} edges held')
            assert drapes[scheme].active_constraints > 0
    exact = drapes['list']
    for scheme in ('lattice', 'whole'):
        other = drapes[scheme]
        within(f'distance of {scheme} and list over the side',
               np.abs(other.positions - exact.positions).max() / SIDE, 1e-3)
        # In scheme whole edges pass the limit by up to a twentieth of it, and store energy there.
        for name in ('elastic_energy', 'gravitational_energy'):
            apart = abs(getattr(other, name) - getattr(exact, name))
            within(f'{name} of {scheme} and list, over M g and the side', apart / WEIGHT, 1e-3)
    within('elastic energy of lattice and list, relative',
           abs(drapes['lattice'].elastic_energy / exact.elastic_energy - 1.0), 1e-3)


@pytest.mark.parametrize('pair', [
    ('list', 'lattice'), ('list', 'whole'), ('lattice', 'whole')], ids='-'.join)
def test_taking_turns_gains_no_energy(context, pair):
    """Each handing over would throw what is held, or let go of it."""
    values = {'damping.structural': 1e-4, 'damping.shear': 1e-4, 'damping.bend': 1e-4}
    with start(context, pair[0], **values) as first, start(context, pair[1], **values) as second:
        begin = first.measure().total_energy
        most, held, now, other = begin, 0, first, second
        for _ in range(60):
            now.step(3)
            snapshot = now.snapshot()
            held += snapshot.active_constraints > 0
            most = max(most, snapshot.total_energy)
            other.set_state(snapshot.positions, snapshot.velocities)
            now, other = other, now
    assert held > 20
    within('energy gained over M g and the side', (most - begin) / WEIGHT, 1e-3)


def test_the_chosen_way_changes_and_gains_no_energy(context):
    """What the mode hands over to itself would come with energy."""
    values = {
        'rows': 12, 'cols': 12, 'damping.structural': 1e-4, 'damping.shear': 1e-4,
        'damping.bend': 1e-4, 'pins': ['top_left']}
    ways = []
    with start(context, 'constraint', **values) as simulation:
        account = EnergyAccount(simulation)
        for _ in range(240):
            account.step(1)
            snapshot = simulation.snapshot()
            ways.append((
                snapshot.calm_substeps > 0, snapshot.listed_substeps > 0,
                snapshot.whole_substeps > 0))
    print(f'{len(set(ways))} kinds of steps, {np.mean(ways, axis=0)} calm, listed, whole')
    assert len(set(ways)) > 1
    within('energy gained, relative', account.gained, 1e-3)
