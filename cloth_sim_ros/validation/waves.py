# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Longitudinal standing waves of a chain: the lattice's and the step's own frequency."""

from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.validation.row import exactly
from cloth_sim_ros.validation.row import Figure
from cloth_sim_ros.validation.springs import PLAIN
import numpy as np
from scipy.optimize import curve_fit

_STIFFNESS = 100.0  # [N/m]
_MASS = 0.01        # of a node [kg]


def frequency(
        context: Context, mode: str, nodes: int, wave: int, dt: float, **values: Any) -> Figure:
    """
    Return that of a standing wave with ``wave`` half waves on a chain, from 20 periods [Hz].

    Omega = (2 / dt) asin(omega dt / 2), omega = 2 sqrt(k / m) sin(q / 2): a formula of the
    lattice and of symplectic Euler.
    """
    q = np.pi * wave / (nodes - 1)
    lattice = 2.0 * np.sqrt(_STIFFNESS / _MASS) * np.sin(q / 2.0)
    exact = 2.0 / dt * np.arcsin(lattice * dt / 2.0)
    with Simulation(Scene({
            **PLAIN, 'mode': mode, 'rows': 1, 'cols': nodes, 'width': 3.2,
            'pins': ['top_left', 'top_right'], 'node_mass': _MASS, 'start.z': 0.0,
            'gravity': [0.0, 0.0, 0.0], 'dt': dt, 'auto_substeps': False,
            'stiffness.structural': _STIFFNESS, 'damping.structural': 0.0,
            'stiffness.bend': 0.0, 'damping.bend': 0.0, **values}),
            context=context) as simulation:
        start = simulation.snapshot()
        rest = start.positions[0, :, 0].astype(float)
        shape = np.sin(q * np.arange(nodes))
        displaced = start.positions.copy()
        displaced[0, 1:-1, 0] += 1e-3 * shape[1:-1]
        simulation.set_state(displaced, start.velocities)
        # 8 samples a period are enough for a fit.
        stride = max(1, round(2.0 * np.pi / exact / dt / 8.0))
        times, amplitudes = [], []
        while simulation.time < 20.0 * 2.0 * np.pi / exact:
            simulation.step(stride)
            times.append(simulation.time)
            moved = simulation.positions()[0, :, 0].astype(float) - rest
            amplitudes.append(moved @ shape / (shape @ shape))

    def wave_at(t: np.ndarray, frequency: float, cosine: float, sine: float) -> np.ndarray:
        return cosine * np.cos(frequency * t) + sine * np.sin(frequency * t)

    found = curve_fit(wave_at, np.array(times), amplitudes, p0=(exact, 1e-3, 0.0))[0][0]
    return exactly(found / (2.0 * np.pi), exact / (2.0 * np.pi))
