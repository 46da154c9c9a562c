# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What holds for the edges at their limit whatever the way they are solved for."""

from contextlib import closing

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.energy_account import EnergyAccount
from measured import within
import numpy as np
import pytest

SCHEMES = ('constraint', 'list', 'lattice', 'whole')
# The springs of a scene without any values, light and soft, come to a limit of 2 %.
SOFT = {
    'material.preset': 'none', 'mode': 'adaptive', 'rows': 12, 'cols': 12, 'dt': 0.01,
    'adaptive.threshold': 0.02}


def start(context, scheme, **values):
    """Return a simulation in ``scheme`` that ends with a ``with``."""
    scene = Scene({**SOFT, 'adaptive.scheme': scheme, **values})
    return closing(Simulation(scene, context=context))


@pytest.mark.parametrize('scheme', SCHEMES)
def test_same_bits_twice(context, scheme):
    """A list is filled in another order each time, or something of the run before is left."""
    hashes = []
    with start(context, scheme) as simulation:
        for _ in range(2):
            simulation.advance(0.5)
            assert simulation.snapshot().active_constraints > 0
            simulation.push((0.0, 1.0, 1.0), duration=0.1, region='sphere', radius=2.0)
            simulation.advance(0.3)
            hashes.append(simulation.snapshot().state_sha256)
            simulation.reset()
    with start(context, scheme) as simulation:
        simulation.advance(0.5)
        simulation.push((0.0, 1.0, 1.0), duration=0.1, region='sphere', radius=2.0)
        simulation.advance(0.3)
        hashes.append(simulation.snapshot().state_sha256)
    assert hashes[0] == hashes[1] == hashes[2]


@pytest.mark.parametrize('scheme', SCHEMES)
@pytest.mark.parametrize('values', [
    {}, {'adaptive.threshold': 0.1}, {'adaptive.threshold': 0.005}, {'pins': ['top_left']},
    {'stiffness.shear': 0.0, 'damping.shear': 0.0},
    {'damping.structural': 0.0, 'damping.shear': 0.0, 'damping.bend': 0.0}], ids=str)
def test_a_falling_cloth_gains_no_energy(context, scheme, values):
    """The impulses of a limit throw the cloth."""
    with start(context, scheme, **values) as simulation:
        account, held = EnergyAccount(simulation), 0
        for _ in range(100):
            account.step(1)
            held += simulation.snapshot().active_constraints > 0
    assert held > 20
    within('energy gained, relative', account.gained, 1e-3)


@pytest.mark.parametrize('scheme', SCHEMES)
def test_a_cloth_of_the_default_scene_gains_no_energy(context, scheme):
    """A user's first cloth in this mode is thrown by its limit."""
    with closing(Simulation(Scene({
            'mode': 'adaptive', 'adaptive.scheme': scheme}), context=context)) as simulation:
        account = EnergyAccount(simulation)
        for _ in range(60):
            account.step(1)
        assert np.isfinite(simulation.positions()).all()
    within('energy gained, relative', account.gained, 1e-3)
