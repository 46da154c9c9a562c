# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A fabric, which is a cloth of cells, against the float64 reference, and its momentum."""

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
from cloth_sim_ros.sim.batch import Batch
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.energy_account import EnergyAccount
from momenta import momenta_of
import numpy as np
import pytest

REFERENCES = {'mass_spring': MassSpringReference, 'constraint': ImplicitCloth}
FABRIC = {
    'rows': 7, 'cols': 9, 'width': 0.4, 'height': 0.3, 'dt': 0.002, 'material.preset': 'trousers',
    'air.density': 0.0, 'solver.tolerance': 1e-5}
PUSHED = {
    'pushes.start': [0.05], 'pushes.duration': [0.02], 'pushes.force': [0.1, 0.3, 0.6]}
KINDS = {
    'plain': {}, 'damped bending': {'bending.damping': 0.01},
    'bend springs': {'stiffness.bend': 0.5, 'damping.bend': 1e-3},
    'warp and weft': {'damping.structural': [0.05, 0.02], 'damping.shear': 0.01}}
ALL_MODES = ('mass_spring', 'constraint', 'adaptive')


@pytest.mark.parametrize('kind', KINDS.values(), ids=KINDS)
@pytest.mark.parametrize('mode', REFERENCES)
def test_a_fabric_moves_as_the_reference(context, within, mode, kind):
    """Masses and shares of a mode, its pushes or its energies are others than of the cells."""
    scene = Scene({**FABRIC, **PUSHED, **kind, 'mode': mode})
    assert scene.cells is not None
    exact = REFERENCES[mode](scene)
    with Simulation(scene, context=context) as simulation:
        simulation.step(75)
        exact.step(75)
        seen, energies = simulation.snapshot(), exact.energies()
    within('distance of a node [m]', np.abs(seen.positions - exact.positions).max(), 2e-5)
    scale = energies.kinetic + energies.elastic
    within('kinetic energy, relative', abs(seen.kinetic_energy - energies.kinetic) / scale, 1e-4)
    within('elastic energy, relative', abs(seen.elastic_energy - energies.elastic) / scale, 1e-4)
    within('gravitational energy, relative',
           abs(seen.gravitational_energy - energies.gravitational) / scale, 1e-3)


@pytest.mark.parametrize('mode', ALL_MODES)
def test_a_free_fabric_keeps_its_momenta(context, within, mode):
    """Impulses between nodes of unequal masses would not be equal and opposite."""
    scene = Scene({
        **FABRIC, 'mode': mode, 'pins': ['none'], 'gravity': [0.0, 0.0, 0.0],
        'adaptive.threshold': 0.005})
    random = np.random.default_rng(5)
    with Simulation(scene, context=context) as simulation:
        rest = scene.rest_positions()
        simulation.set_state(rest, random.uniform(-0.3, 0.3, rest.shape))
        before = momenta_of(simulation)
        simulation.step(50)
        after = momenta_of(simulation)
    size = 0.3 * scene.mass
    within('momentum, relative', np.abs(after[0] - before[0]).max() / size, 1e-6)
    within('angular momentum, relative to 0.4 m',
           np.abs(after[1] - before[1]).max() / (0.4 * size), 5e-6)


@pytest.mark.parametrize('scene', [
    {'mode': 'mass_spring'}, {'mode': 'constraint'},
    *({'mode': 'adaptive', 'adaptive.threshold': 0.02, 'adaptive.scheme': scheme}
      for scheme in ('list', 'lattice', 'whole'))], ids=lambda scene: '-'.join(
          str(value) for name, value in scene.items() if name != 'adaptive.threshold'))
def test_a_pushed_fabric_gains_no_energy(context, within, scene):
    """Nodes at the border would be given another energy than what is counted."""
    with Simulation(Scene({**FABRIC, **PUSHED, **scene}), context=context) as simulation:
        account = EnergyAccount(simulation)
        while simulation.time < 0.3:
            account.step()
    within('energy gained, relative to the largest kinetic energy', account.gained, 1e-3)


@pytest.mark.parametrize('mode', ALL_MODES)
def test_pins_carry_what_a_fabric_weighs(context, within, mode):
    """A pinned node at the border would weigh as much as one inside."""
    scene = Scene({
        **FABRIC, 'mode': mode, 'pins': ['top_edge', '3,4'], 'start.pose': 'hanging',
        'damping.structural': 0.05, 'damping.shear': 0.05, 'adaptive.threshold': 0.5})
    with Simulation(scene, context=context) as simulation:
        simulation.advance(0.3)
        window = simulation.open_force_window()
        simulation.advance(0.6)
        forces = simulation.frame_forces(window).pins.forces.sum(axis=0)
    weight = scene.mass * 9.81
    within('force on all pins, relative to the weight',
           np.abs(forces - (0.0, 0.0, -weight)).max() / weight, 2e-3)


def test_a_push_gives_its_impulse_to_a_fabric(context, within):
    """A push on a corner, where nodes are light, would give less."""
    scene = Scene({**FABRIC, 'pins': ['none'], 'gravity': [0.0, 0.0, 0.0]})
    corner = scene.rest_positions()[0, 0]
    with Simulation(scene, context=context) as simulation:
        simulation.push(
            (0.0, 0.0, 0.2), duration=0.01, region='sphere', center=tuple(corner), radius=0.06)
        simulation.step(10)
        velocities = simulation.velocities().astype(float)
    given = np.sum(scene.node_mass * scene.node_shares[..., None] * velocities, axis=(0, 1))
    within('impulse [N s], relative', abs(given[2] / 0.002 - 1.0), 1e-5)


def test_fabrics_in_a_batch_have_the_bits_of_one(context):
    """Cloths below one another would take shares from each other."""
    scenes = [Scene({**FABRIC, 'start.z': 1.0 + 0.1 * number}) for number in range(3)]
    with Batch(scenes, context=context) as batch:
        batch.step(20)
        found = batch.positions()
    for scene, positions in zip(scenes, found):
        with Simulation(scene, context=context) as simulation:
            simulation.step(20)
            np.testing.assert_array_equal(positions, simulation.positions())
