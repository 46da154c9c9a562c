# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The implicit step of one edge that hangs from a pin, against closed forms."""

from dataclasses import replace

from cloth_sim_ros.reference.edge_law import constraint_law
from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
from cloth_sim_ros.reference.implicit_step import Passes
from cloth_sim_ros.reference.rigid_links import GRAVITY
from cloth_sim_ros.reference.rigid_links import period_error
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest

ROD = {'rows': 2, 'cols': 1, 'height': 1.0, 'node_mass': 0.1, 'pins': ['top_left'],
       'start.pose': 'hanging', 'auto_substeps': False, 'constraint.strain': 1e-5}
SPRING = {'constraint.hard': [], 'constraint.springs': ['structural']}
# Two solves, but nothing that allows for the turn before the second.
BLIND = Passes(foresees_turn=False)


def _rod(angle, dt, passes=None, *, compliance=None, **values):
    """Return a rod of 1 m, held above, at its angle [rad] from below."""
    scene = Scene({**ROD, 'dt': dt, **values})
    law = constraint_law(scene)
    if compliance is not None:
        law = replace(law, compliance=np.full(1, compliance))
    rod = ImplicitCloth(scene, law, passes=passes)
    rod.positions[1, 0] = rod.positions[0, 0] + [np.sin(angle), 0.0, -np.cos(angle)]
    return rod


def _swing(rod, seconds):
    """Return at each step the offset of the lower end, its velocity, and the tension."""
    offsets, velocities, tensions = [], [], []
    for _ in range(round(seconds / rod.dt)):
        rod.step()
        offsets.append(rod.positions[1, 0] - rod.positions[0, 0])
        velocities.append(rod.velocities[1, 0].copy())
        tensions.append(rod.tension[0])
    return np.array(offsets), np.array(velocities), np.array(tensions)


@pytest.mark.parametrize('dt', [0.02, 0.01, 0.005])
def test_pendulum_with_one_solve(dt):
    """The period is not exact to second order, or the length not off by (omega h)^2 / 2."""
    offsets, velocities, _ = _swing(_rod(1.0, dt, **{'constraint.newton_iterations': 1}), 10.0)
    error = period_error(offsets, dt)
    longer = np.max(np.abs(np.linalg.norm(offsets, axis=1) - 1.0))
    foreseen = np.max(np.sum(velocities**2, axis=1)) * dt**2 / 2.0
    print(f'measured: dt {dt} dT/T {error:.2e} length {longer:.3e} formula {foreseen:.3e}')
    assert abs(error) < 3e-4 * (dt / 0.01)**2
    assert longer == pytest.approx(foreseen, rel=0.1)


@pytest.mark.parametrize('dt', [0.02, 0.01])
def test_pendulum_with_two_solves(dt):
    """The turn that the first solve foresees is not the one that the second finds."""
    offsets, _, _ = _swing(_rod(1.0, dt), 10.0)
    error = period_error(offsets, dt)
    longer = np.max(np.abs(np.linalg.norm(offsets, axis=1) - 1.0))
    print(f'measured: dt {dt} dT/T {error:.2e} length {longer:.1e}')
    assert abs(error) < 3e-4 * (dt / 0.01)**2
    assert longer < 1e-6


@pytest.mark.parametrize('solves', [1, 2])
def test_pendulum_keeps_its_energy(solves):
    """A swing of 20 s is damped or driven."""
    offsets, velocities, _ = _swing(
        _rod(1.0, 0.01, **{'constraint.newton_iterations': solves}), 20.0)
    energy = np.sum(velocities**2, axis=1) / 2.0 + GRAVITY * (offsets[:, 2] + 1.0)
    start = GRAVITY * (1.0 - np.cos(1.0))
    print(f'measured: {solves} solves, energy of the last second '
          f'{energy[-100:].mean() / start:.4f}')
    assert energy[-100:].mean() == pytest.approx(start, rel=0.01)


@pytest.mark.parametrize('passes', [None, BLIND], ids=['foreseen', 'not foreseen'])
def test_a_second_solve_meets_the_law(passes):
    """Where a rod has come to, its tension is not what the law has for its length there."""
    offsets, _, tensions = _swing(_rod(1.0, 0.01, passes, compliance=1e-4), 2.0)
    stretched = np.linalg.norm(offsets, axis=1) - 1.0
    assert np.max(np.abs(stretched)) > 1e-4
    np.testing.assert_allclose(stretched, 1e-4 * tensions, atol=1e-13)


def test_the_price_of_a_turn_that_is_not_foreseen():
    """A free rod does not lose speed by 1 / sqrt(1 + (omega h)^2) a step."""
    rod = _rod(0.0, 0.01, BLIND, compliance=1e-11, gravity=[0.0, 0.0, 0.0])
    rod.velocities[1, 0] = [5.0, 0.0, 0.0]
    offsets, _, _ = _swing(rod, 2.0)
    angles = np.unwrap(np.arctan2(offsets[:, 0], -offsets[:, 2]))
    turns = np.diff(angles, prepend=0.0)
    np.testing.assert_allclose(
        np.tan(turns), 0.05 / np.sqrt(1.0 + 0.05**2 * np.arange(200)), rtol=1e-6)


def test_a_free_rod_turns_on():
    """With the turn foreseen, a free rod loses or gains more than in fourth order of omega h."""
    rod = _rod(0.0, 0.01, compliance=1e-11, gravity=[0.0, 0.0, 0.0])
    rod.velocities[1, 0] = [5.0, 0.0, 0.0]
    _, velocities, _ = _swing(rod, 2.0)
    speeds = np.linalg.norm(velocities, axis=1)
    lost = 1.0 - speeds[-1] / speeds[1]
    print(f'measured: speed lost in 200 steps at omega h = 0.05: {lost:.1e}')
    assert abs(lost) < 200 * 0.05**4


@pytest.mark.parametrize('solves', [1, 2])
def test_implicit_spring_follows_its_recurrence(solves):
    """A spring is not v+ = (v - h k x / m) / (1 + h k_d / m + h^2 k / m)."""
    k, damping, mass, h = 100.0, 0.2, 0.1, 0.01
    rod = _rod(0.0, h, **{
        **SPRING, 'gravity': [0.0, 0.0, 0.0], 'stiffness.structural': k,
        'damping.structural': damping, 'constraint.newton_iterations': solves})
    rod.positions[1, 0, 2] -= 0.05
    offsets, velocities, _ = _swing(rod, 1.0)
    x, v = 0.05, 0.0
    for offset, velocity in zip(offsets, velocities):
        v = (v - h * k * x / mass) / (1.0 + h * damping / mass + h**2 * k / mass)
        x += h * v
        assert -offset[2] - 1.0 == pytest.approx(x, abs=1e-12)
        assert -velocity[2] == pytest.approx(v, abs=1e-10)


@pytest.mark.parametrize('solves', [1, 2])
def test_a_hard_edge_is_a_spring_of_its_compliance(solves):
    """A hard edge is something else than a spring with k = 1 / E."""
    values = {'constraint.newton_iterations': solves}
    hard = _rod(1.0, 0.01, compliance=1e-5, **values)
    spring = _rod(1.0, 0.01, **{
        **SPRING, 'stiffness.structural': 1e5, 'damping.structural': 0.0, **values})
    for rod in (hard, spring):
        rod.step(50)
    np.testing.assert_allclose(hard.positions, spring.positions, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(hard.tension, spring.tension, rtol=1e-9)
