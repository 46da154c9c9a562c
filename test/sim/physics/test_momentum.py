# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A free cloth in no field keeps its linear and angular momentum."""

from momenta import momenta
import numpy as np


def test_momentum_over_ten_thousand_steps(simulate, within, mode, layout):
    """The two ends of a spring do not feel opposite forces along it."""
    simulation = simulate({
        'mode': mode, 'layout': layout, 'rows': 16, 'cols': 16, 'pins': ['none'],
        'gravity': [0.0, 0.0, 0.0], 'start.z': 0.0, 'stiffness.bend': 100.0,
        'damping.bend': 0.01, 'dt': 5e-4, 'auto_substeps': False})
    random = np.random.default_rng(3)
    start = simulation.snapshot()
    shape = start.positions.shape
    simulation.set_state(
        (start.positions + random.standard_normal(shape) / 150.0).astype(np.float32),
        random.standard_normal(shape).astype(np.float32))
    before = momenta(simulation.snapshot())
    simulation.step(10_000)
    after = momenta(simulation.snapshot())
    within('linear momentum, change over sum of |v|',
           np.abs(after[0] - before[0]).max() / before[2], 1e-6)
    within('angular momentum, change over sum of |x| |v|',
           np.abs(after[1] - before[1]).max() / before[3], 5e-6)
