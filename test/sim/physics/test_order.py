# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The shaders' motion converges to that of the same springs in continuous time."""

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.sim.scene import Scene
import numpy as np
from scipy.integrate import solve_ivp

SECONDS = 0.25


def test_first_order_against_dop853(simulate, mode, layout):
    """The error against scipy's DOP853 is not of first order in dt."""
    values = {
        'mode': mode, 'layout': layout, 'rows': 8, 'cols': 8, 'auto_substeps': False,
        'stiffness.structural': 20.0, 'stiffness.shear': 20.0, 'stiffness.bend': 2.0}
    begin = MassSpringReference(Scene(values))
    exact = solve_ivp(
        begin.right_hand_side, (0.0, SECONDS),
        np.concatenate((begin.positions.ravel(), begin.velocities.ravel())),
        method='DOP853', rtol=1e-10, atol=1e-11)
    target = exact.y[:begin.positions.size, -1].reshape(begin.positions.shape)
    errors = []
    for dt in (1e-3, 5e-4, 2.5e-4):
        simulation = simulate({**values, 'dt': dt})
        simulation.advance(SECONDS)
        miss = simulation.snapshot().positions - target
        errors.append(np.sqrt(np.mean(np.sum(miss**2, axis=-1))))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    print(f'measured {orders.round(3)} of 0.95 to 1.1 allowed: order against DOP853')
    assert np.all((orders > 0.95) & (orders < 1.1))
