# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A symmetric scene stays symmetric as long as rounding has not grown."""

import numpy as np


def test_mirror_symmetry(simulate, within, any_mode, layout):
    """Left and right are not treated alike: a neighbour is missing or counted twice."""
    simulation = simulate({
        'mode': any_mode, 'layout': layout, 'rows': 16, 'cols': 16, 'dt': 0.001,
        'auto_substeps': False})
    simulation.advance(0.5)
    positions = simulation.snapshot().positions.astype(float)
    mirrored = positions[:, ::-1] * [-1.0, 1.0, 1.0]
    within('mirror symmetry at 0.5 s [m]', np.abs(positions - mirrored).max(), 2e-5)
