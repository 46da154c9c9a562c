# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Free fall: z = -g t (t + dt) / 2 in the recurrence of symplectic Euler."""

import numpy as np
import pytest


@pytest.mark.parametrize('dt', [0.01, pytest.param(0.001, marks=pytest.mark.long)])
def test_free_fall(simulate, within, any_mode, layout, dt):
    """Gravity, dt or the order of velocity and position is not the scheme's."""
    simulation = simulate({
        'mode': any_mode, 'layout': layout, 'rows': 12, 'cols': 9, 'dt': dt,
        'pins': ['none'], 'start.z': 0.0, 'auto_substeps': False,
        'stiffness.structural': 1.0, 'stiffness.shear': 1.0, 'stiffness.bend': 1.0,
        'damping.structural': 0.0, 'damping.shear': 0.0, 'damping.bend': 0.0})
    simulation.advance(1.0)
    snapshot = simulation.snapshot()
    assert snapshot.steps == round(1.0 / dt)
    exact = -9.81 * (1.0 + dt) / 2.0
    error = np.abs(snapshot.positions[..., 2] / exact - 1.0).max()
    within(f'free fall, dt {dt:g} s, relative', error, 5e-6)
