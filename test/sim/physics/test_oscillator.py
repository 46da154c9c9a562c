# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One spring and one free node: the oscillator of the discrete scheme, to the last digit."""

import numpy as np
import pytest

STIFFNESS = 100.0
MASS = 0.1
AMPLITUDE = 0.05


def _trajectory(simulate, mode, layout, dt, seconds, damping):
    """Return the stretch and its rate after each step, the first before any."""
    simulation = simulate({
        'mode': mode, 'layout': layout, 'rows': 2, 'cols': 1, 'height': 1.0,
        'pins': ['top_left'], 'node_mass': MASS, 'start.z': 0.0, 'gravity': [0.0, 0.0, 0.0],
        'stiffness.structural': STIFFNESS, 'damping.structural': damping,
        'dt': dt, 'auto_substeps': False})
    start = simulation.snapshot()
    positions = start.positions.copy()
    positions[1, 0, 1] -= AMPLITUDE
    simulation.set_state(positions, start.velocities)
    states = []
    for _ in range(round(seconds / dt) + 1):
        snapshot = simulation.snapshot()
        states.append((-0.5 - float(snapshot.positions[1, 0, 1]),
                       -float(snapshot.velocities[1, 0, 1])))
        simulation.step()
    return np.array(states)


def _crossings(stretch, dt):
    before = np.flatnonzero(np.diff(np.sign(stretch)))
    return (before + stretch[before] / (stretch[before] - stretch[before + 1])) * dt


@pytest.mark.parametrize('dt', [0.01, pytest.param(0.001, marks=pytest.mark.long)])
def test_period_and_trajectory(simulate, within, mode, layout, dt):
    """The spring's frequency is not that of cos(Omega dt) = 1 - (omega dt)^2 / 2."""
    stretch = _trajectory(simulate, mode, layout, dt, 2.0, damping=0.0)[:, 0]
    squared = STIFFNESS / MASS * dt**2
    phase = np.arccos(1.0 - squared / 2.0)
    sine = (AMPLITUDE * (1.0 - squared) - AMPLITUDE * np.cos(phase)) / np.sin(phase)
    steps = np.arange(stretch.size)
    exact = AMPLITUDE * np.cos(steps * phase) + sine * np.sin(steps * phase)
    # The zeros of straight lines between the steps lie off those of the curve, in both alike.
    period = np.diff(_crossings(stretch, dt)[[0, -1]])[0]
    exact_period = np.diff(_crossings(exact, dt)[[0, -1]])[0]
    within(f'oscillator period, dt {dt:g} s, relative', abs(period / exact_period - 1.0), 1e-5)
    within(f'oscillator trajectory, dt {dt:g} s, over amplitude',
           np.abs(stretch - exact).max() / AMPLITUDE, 2e-4)


@pytest.mark.parametrize('dt', [0.005, pytest.param(0.001, marks=pytest.mark.long)])
def test_damped_decay(simulate, within, mode, layout, dt):
    """Damping takes away more or less than -ln(1 - k_d dt / m) / (2 dt)."""
    damping = 0.2
    states = _trajectory(simulate, mode, layout, dt, 1.5, damping)
    # A step maps the states of two runs linearly; the determinant is the decay squared.
    before, after = states[:-1], states[1:]
    step = np.linalg.lstsq(before, after, rcond=None)[0]
    rate = -np.log(np.linalg.det(step)) / (2.0 * dt)
    exact = -np.log(1.0 - damping * dt / MASS) / (2.0 * dt)
    within(f'damped oscillator rate, dt {dt:g} s, relative', abs(rate / exact - 1.0), 1e-4)
