# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Without damping the energy neither drifts nor ripples more than the scheme's order says."""

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest

WEIGHT = 0.2 * 9.81


def _scene_values(mode, layout, dt):
    return {
        'mode': mode, 'layout': layout, 'rows': 16, 'cols': 16, 'dt': dt,
        'auto_substeps': False, 'stiffness.bend': 100.0,
        'damping.structural': 0.0, 'damping.shear': 0.0, 'damping.bend': 0.0}


def _largest_errors(simulate, mode, layout, dt):
    """Return the largest energy error over M g L: as reported, and with v half a step later."""
    simulation = simulate(_scene_values(mode, layout, dt))
    oracle = MassSpringReference(Scene(_scene_values(mode, layout, dt)))
    start = simulation.snapshot().total_energy
    plain, centred = [], []
    for _ in range(150):
        simulation.advance(0.02)
        snapshot = simulation.snapshot()
        plain.append(snapshot.total_energy - start)
        oracle.positions = snapshot.positions.astype(float)
        oracle.velocities = snapshot.velocities.astype(float)
        # The scheme's velocities are those of half a step before its positions.
        oracle.velocities += 0.5 * dt * oracle.accelerations(
            oracle.positions, oracle.velocities)
        centred.append(oracle.energies().total - start)
    return np.abs(plain).max() / WEIGHT, np.abs(centred).max() / WEIGHT


@pytest.mark.parametrize(
    'layout', ['fused', pytest.param('paper', marks=pytest.mark.long)], indirect=True)
def test_energy_stays_and_its_error_follows_dt(simulate, within, mode, layout):
    """Energy drifts, or its error does not shrink as symplectic Euler's does."""
    coarse, coarse_centred = _largest_errors(simulate, mode, layout, 1e-3)
    fine, fine_centred = _largest_errors(simulate, mode, layout, 2.5e-4)
    within('undamped energy over 3 s, dt 1 ms, over M g L', coarse, 1e-2)
    within('undamped energy, error at dt / 4 over that at dt', fine / coarse, 0.3)
    within('the same with the velocity at the time of the positions',
           fine_centred / coarse_centred, 0.15)
