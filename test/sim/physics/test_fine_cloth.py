# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Fine cloth: what rounding positions to float32 does where rest lengths are short."""

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest

_SECONDS = 0.05


def root_mean_square(vectors: np.ndarray) -> float:
    """Return the root mean square length of (rows, cols, 3) vectors."""
    return float(np.sqrt(np.mean(np.sum(vectors.astype(np.float64)**2, axis=-1))))


@pytest.mark.parametrize(('nodes', 'allowed'), [
    (32, 2e-3), (64, 4e-3), pytest.param(128, 8e-3, marks=pytest.mark.long)])
def test_rounding_makes_the_velocities_of_fine_cloth_noisy(context, nodes: int, allowed: float):
    """The noise would be more than docs/explanation/numerics.md tells, or reach the positions."""
    scene = Scene({
        'rows': nodes, 'cols': nodes, 'stiffness.structural': 1000.0, 'stiffness.shear': 200.0,
        **{f'damping.{family}': 1.3e-3 / nodes for family in ('structural', 'shear', 'bend')}})
    simulation, reference = Simulation(scene, context=context), MassSpringReference(scene)
    simulation.advance(_SECONDS)
    reference.advance(_SECONDS)
    snapshot = simulation.snapshot()
    position_error = root_mean_square(snapshot.positions - reference.positions)
    velocity_error = root_mean_square(snapshot.velocities - reference.velocities)
    kinetic = snapshot.kinetic_energy / reference.energies().kinetic - 1.0
    print(f'measured: {nodes} x {nodes} nodes: velocities {velocity_error:.1e} m/s RMS, '
          f'positions {position_error:.1e} m RMS, kinetic energy {kinetic:.1e}')
    assert velocity_error < allowed
    assert position_error < 1e-6
    assert abs(kinetic) < 1e-3
