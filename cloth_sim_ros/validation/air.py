# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A level sheet that falls through still air comes to its terminal speed."""

import math

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.validation.row import exactly
from cloth_sim_ros.validation.row import Figure
from cloth_sim_ros.validation.springs import PLAIN
import numpy as np

DENSITY, DRAG, GRAVITY = 1.225, 1.17, 9.81  # [kg/m3, 1, m/s2]


def terminal_speed(sigma: float) -> float:
    """Return sqrt(2 sigma g / (rho Cn)) for a sheet of ``sigma`` [kg/m2], in m/s."""
    return math.sqrt(2.0 * sigma * GRAVITY / (DENSITY * DRAG))


def fallen(
        context: Context, mode: str, side: int, sigma: float, dt: float) -> np.ndarray:
    """Return the speeds at which the nodes fall in the end, (side, side) [m/s]."""
    speed = terminal_speed(sigma)
    with Simulation(Scene({
            'rows': side, 'cols': side, 'mode': mode, 'pins': ['none'], 'air.density': DENSITY,
            'areal_density': sigma, 'dt': dt, **PLAIN}), context=context) as simulation:
        flat = simulation.scene.rest_positions()
        simulation.set_state(flat, np.broadcast_to((0.0, 0.0, -0.97 * speed), flat.shape))
        # Differences fall by exp(-2 g t / v).
        simulation.advance(4.5 * speed / (2.0 * GRAVITY) + dt)
        return -simulation.velocities()[..., 2]


def mean_speed(context: Context, mode: str, side: int, sigma: float, dt: float) -> Figure:
    """Return the mean speed in the end [m/s]."""
    return exactly(float(fallen(context, mode, side, sigma, dt).mean()), terminal_speed(sigma))
