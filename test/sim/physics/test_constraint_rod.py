# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The constraint mode against closed forms of one rod, held at one end."""

from cloth_sim_ros.reference.rigid_links import GRAVITY
from cloth_sim_ros.reference.rigid_links import period_error
from cloth_sim_ros.validation.pendulums import ROD
from cloth_sim_ros.validation.pendulums import swing
import numpy as np
import pytest

PAPER = {'constraint.newton_iterations': 1}


@pytest.mark.parametrize('dt', [0.02, 0.01, pytest.param(0.005, marks=pytest.mark.long)])
def test_pendulum_of_the_paper(context, within, dt):
    """The period is not 4 sqrt(L/g) K to second order, or the length not off (omega h)^2/2."""
    offsets, velocities = swing(context, 1.0, 10.0, dt=dt, **PAPER)
    longer = np.max(np.abs(np.linalg.norm(offsets, axis=1) - 1.0))
    foreseen = np.max(np.sum(velocities**2, axis=1)) * dt**2 / 2.0
    within('period of a rod', abs(period_error(offsets, dt)), 3e-4 * (dt / 0.01)**2)
    within('length of a rod over (omega dt)^2 / 2, less 1', abs(longer / foreseen - 1.0), 0.1)


@pytest.mark.parametrize('dt', [0.02, pytest.param(0.01, marks=pytest.mark.long)])
def test_pendulum(context, within, dt):
    """The turn that the first solve foresees is not the one that the second finds."""
    offsets, _ = swing(context, 1.0, 10.0, dt=dt)
    within('period of a rod', abs(period_error(offsets, dt)), 3e-4 * (dt / 0.01)**2)
    within('length of a rod', np.max(np.abs(np.linalg.norm(offsets, axis=1) - 1.0)), 3e-6)


@pytest.mark.parametrize('values', [
    pytest.param(PAPER, id='one solve', marks=pytest.mark.long),
    pytest.param({}, id='two solves')])
def test_pendulum_keeps_its_energy(context, within, values):
    """A swing of 20 s is damped or driven."""
    offsets, velocities = swing(context, 1.0, 20.0, dt=0.02, **values)
    energy = np.sum(velocities**2, axis=1) / 2.0 + GRAVITY * (offsets[:, 2] + 1.0)
    start = GRAVITY * (1.0 - np.cos(1.0))
    within('energy after 20 s, change', abs(energy[-50:].mean() / start - 1.0), 0.01)


def test_implicit_spring_follows_its_recurrence(simulate, within):
    """A spring that is not hard is not v+ = (v - h k x / m) / (1 + h k_d / m + h^2 k / m)."""
    k, damping, mass, h = 100.0, 0.2, 0.1, 0.01
    simulation = simulate({
        **ROD, 'dt': h, 'constraint.hard': [], 'constraint.springs': ['structural'],
        'gravity': [0.0, 0.0, 0.0], 'stiffness.structural': k, 'damping.structural': damping})
    positions = simulation.snapshot().positions.copy()
    positions[1, 0, 2] -= 0.05
    simulation.set_state(positions, np.zeros_like(positions))
    x, v, worst = 0.05, 0.0, 0.0
    for _ in range(100):
        simulation.step()
        v = (v - h * k * x / mass) / (1.0 + h * damping / mass + h**2 * k / mass)
        x += h * v
        offset = np.diff(simulation.snapshot().positions[:, 0, 2].astype(float))[0]
        worst = max(worst, abs(-offset - 1.0 - x))
    within('implicit spring against its recurrence [m]', worst, 5e-6)
