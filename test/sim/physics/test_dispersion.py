# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Longitudinal standing waves of a chain: the lattice's and the step's own frequency."""

import numpy as np
import pytest
from scipy.optimize import curve_fit

NODES = 33
STIFFNESS = 100.0
MASS = 0.01


@pytest.mark.parametrize(
    'layout', ['fused', pytest.param('paper', marks=pytest.mark.long)], indirect=True)
@pytest.mark.parametrize('wave', [1, 8, 24])
@pytest.mark.parametrize('dt', [0.004, 0.001])
def test_dispersion(simulate, within, mode, layout, wave, dt):
    """Waves do not run at Omega = (2 / dt) asin(omega dt / 2), omega = 2 sqrt(k/m) sin(q/2)."""
    q = np.pi * wave / (NODES - 1)
    lattice = 2.0 * np.sqrt(STIFFNESS / MASS) * np.sin(q / 2.0)
    exact = 2.0 / dt * np.arcsin(lattice * dt / 2.0)
    simulation = simulate({
        'mode': mode, 'layout': layout, 'rows': 1, 'cols': NODES, 'width': 3.2,
        'pins': ['top_left', 'top_right'], 'node_mass': MASS, 'start.z': 0.0,
        'gravity': [0.0, 0.0, 0.0], 'dt': dt, 'auto_substeps': False,
        'stiffness.structural': STIFFNESS, 'damping.structural': 0.0,
        'stiffness.bend': 0.0, 'damping.bend': 0.0})
    start = simulation.snapshot()
    rest = start.positions[0, :, 0].astype(float)
    shape = np.sin(q * np.arange(NODES))
    displaced = start.positions.copy()
    displaced[0, 1:-1, 0] += 1e-3 * shape[1:-1]
    simulation.set_state(displaced, start.velocities)
    # 8 samples a period are enough for a fit.
    stride = max(1, round(2.0 * np.pi / exact / dt / 8.0))
    times, amplitudes = [], []
    while simulation.time < 20.0 * 2.0 * np.pi / exact:
        simulation.step(stride)
        times.append(simulation.time)
        moved = simulation.snapshot().positions[0, :, 0].astype(float) - rest
        amplitudes.append(moved @ shape / (shape @ shape))
    times = np.array(times)

    def wave_at(t, frequency, cosine, sine):
        return cosine * np.cos(frequency * t) + sine * np.sin(frequency * t)

    found = curve_fit(wave_at, times, amplitudes, p0=(exact, 1e-3, 0.0))[0][0]
    within(f'dispersion, wave {wave}, dt {dt:g} s, relative', abs(found / exact - 1.0), 5e-5)
