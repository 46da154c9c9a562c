# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The shaders bend a cloth as the float64 reference does, in every layout and mode."""

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
from cloth_sim_ros.sim.held.pin_forces import bending_pulls
import numpy as np
import pytest

# Oblong cells, two rigidities, and bending that outweighs the springs.
CLOTH = {
    'rows': 7, 'cols': 10, 'width': 0.9, 'height': 0.4, 'start.z': 0.0, 'start.jitter': 0.2,
    'bending.rigidity': [0.05, 0.02], 'stiffness.structural': 20.0, 'stiffness.shear': 10.0,
    'dt': 0.005, 'pins': ['top_left', '3,4'], 'stiffness.bend': 0.0, 'damping.bend': 0.0,
    'constraint.springs': ['structural', 'shear'], 'constraint.hard': [],
    'solver.tolerance': 1e-5}
IMPLICIT = {'mode': 'constraint', 'auto_substeps': False}
PATHS = [
    ({'layout': 'paper'}, MassSpringReference), ({'block': 1}, MassSpringReference),
    ({'block': 4, 'loads': 'texture'}, MassSpringReference),
    ({'block': 2, 'loads': 'storage'}, MassSpringReference),
    (IMPLICIT, ImplicitCloth), ({**IMPLICIT, 'constraint.newton_iterations': 1}, ImplicitCloth)]


@pytest.mark.parametrize('damping', [0.0, 0.02])
@pytest.mark.parametrize(('values', 'reference'), PATHS)
def test_steps(simulate, within, values, reference, damping):
    """A border, a pin, a direction or the length of a step is not what the reference has."""
    simulation = simulate({**CLOTH, **values, 'bending.damping': damping})
    exact = reference(simulation.scene)
    exact.positions = exact.positions.astype(np.float32).astype(float)
    random = np.random.default_rng(4).uniform(-0.5, 0.5, exact.positions.shape)
    exact.velocities = np.where(
        exact.free[..., None], random, 0.0).astype(np.float32).astype(float)
    simulation.set_state(
        exact.positions.astype(np.float32), exact.velocities.astype(np.float32))
    simulation.step(12)
    exact.step(12)
    snapshot = simulation.snapshot()
    moved = np.abs(exact.velocities).max()
    within(f'velocities after 12 steps, of {moved:.2g} m/s, relative',
           np.abs(snapshot.velocities - exact.velocities).max() / moved, 1e-3)
    within('energy, relative',
           abs(snapshot.elastic_energy / exact.energies().elastic - 1.0), 1e-3)


@pytest.mark.parametrize('damping', [0.0, 0.02])
def test_what_pins_feel(simulate, within, damping):
    """A pin would feel the edges and not how the cloth is bent there, or being bent."""
    simulation = simulate({**CLOTH, 'mode': 'mass_spring', 'stiffness.shear': 0.0,
                           'damping.shear': 0.0, 'stiffness.structural': 0.0,
                           'damping.structural': 0.0, 'bending.damping': damping,
                           'dt': 1e-4})
    exact = MassSpringReference(simulation.scene)
    velocities = np.random.default_rng(4).uniform(-0.5, 0.5, exact.positions.shape)
    velocities[~exact.free] = 0.0
    simulation.set_state(exact.positions.astype(np.float32), velocities.astype(np.float32))
    forces = exact.bending.forces(exact.positions) + exact.bending.damping_forces(
        exact.positions, velocities)
    nodes = np.argwhere(np.ones(forces.shape[:2], bool))
    pulls = bending_pulls(simulation.scene, exact.positions, velocities, nodes)
    within('pulls at all nodes, relative',
           np.abs(pulls - forces.reshape(-1, 3)).max() / np.abs(forces).max(), 1e-12)
    # The force in a substep is that of where it begins.
    simulation.step()
    assert simulation.substeps == 1
    held = simulation.pin_forces()
    weight = simulation.scene.node_mass * np.array(simulation.scene['gravity'])
    expected = forces[tuple(held.nodes.T)] + weight
    within('forces at pins, relative',
           np.abs(held.forces - expected).max() / np.abs(expected).max(), 1e-5)
