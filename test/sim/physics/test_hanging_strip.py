# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A chain hung from its top: each spring carries what is below it."""

import numpy as np
import pytest


@pytest.mark.parametrize(
    'layout', ['fused', pytest.param('paper', marks=pytest.mark.long)], indirect=True)
def test_hanging_strip(simulate, within, mode, layout):
    """At rest the springs do not hold the weight below them."""
    nodes, mass, stiffness = 11, 0.01, 50.0
    simulation = simulate({
        'mode': mode, 'layout': layout, 'rows': nodes, 'cols': 1, 'height': 1.0,
        'pins': ['top_left'], 'node_mass': mass, 'start.pose': 'hanging', 'start.z': -0.5,
        'stiffness.structural': stiffness, 'stiffness.bend': 0.0,
        'damping.structural': 0.9, 'damping.bend': 0.0, 'dt': 0.001, 'auto_substeps': False})
    simulation.advance(20.0)
    snapshot = simulation.snapshot()
    height = snapshot.positions[:, 0, 2].astype(float)
    extension = -np.diff(height) - 1.0 / (nodes - 1)
    exact = mass * 9.81 / stiffness * np.arange(nodes - 1, 0, -1)
    within('hanging strip, extension of each spring over the largest',
           np.abs(extension - exact).max() / exact.max(), 1e-4)
    # A speed below half a unit in the last place of 1 m in a step moves no node.
    still = 2.0 * 6e-8 / simulation.dt
    within('hanging strip, speed left [m/s]', np.abs(snapshot.velocities).max(), still)
