# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where a damped cloth comes to rest."""

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
import numpy as np
import pytest


@pytest.mark.parametrize(
    'layout', ['fused', pytest.param('paper', marks=pytest.mark.long)], indirect=True)
def test_rest_shape_is_an_equilibrium(simulate, within, mode, layout):
    """The cloth comes to rest where the springs do not hold its weight."""
    simulation = simulate({
        'mode': mode, 'layout': layout, 'rows': 9, 'cols': 7, 'width': 0.8, 'height': 1.0,
        'start.pose': 'hanging', 'dt': 0.004, 'damping.structural': 0.08,
        'damping.shear': 0.08, 'damping.bend': 0.02})
    simulation.advance(40.0)
    snapshot = simulation.snapshot()
    oracle = MassSpringReference(simulation.scene)
    oracle.positions = snapshot.positions.astype(float)
    left = oracle.accelerations(oracle.positions, oracle.velocities)
    # Half a unit in the last place of a position is worth 12 k 6e-8 m / m_node = 0.03 m/s2.
    within('acceleration left at rest, over g', np.abs(left).max() / 9.81, 3e-3)
    oracle.advance(10.0)
    within('rest shape, against that of the oracle [m]',
           np.abs(snapshot.positions - oracle.positions).max(), 2e-6)
    within('strain at rest, against that of the oracle',
           abs(snapshot.max_strain - oracle.node_strain().max()), 2e-6)
