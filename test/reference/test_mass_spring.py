# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The oracle's scheme against closed forms and against scipy's DOP853."""

from cloth_sim_ros.reference.mass_spring import MassSpringReference
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from springs import SPRINGS

FREE = {'gravity': [0.0, 0.0, 0.0], 'pins': ['none']}


def test_free_fall_follows_its_recurrence():
    """Velocity and position are not stepped in the order of symplectic Euler."""
    cloth = MassSpringReference(Scene({
        **SPRINGS, 'rows': 3, 'cols': 4, 'pins': ['none'], 'start.z': 0.0, 'dt': 0.01,
        'auto_substeps': False}))
    cloth.advance(1.0)
    np.testing.assert_allclose(cloth.positions[..., 2], -9.81 * 1.01 / 2.0, rtol=1e-12)
    assert cloth.time == pytest.approx(1.0)


def test_oscillator_follows_its_recurrence():
    """One spring does not swing with cos(Omega h) = 1 - (omega h)^2 / 2."""
    scene = Scene({**SPRINGS, **FREE, 'rows': 2, 'cols': 1, 'pins': ['top_left'], 'node_mass': 0.1,
                   'start.z': 0.0, 'damping.structural': 0.0, 'dt': 0.01,
                   'auto_substeps': False})
    cloth = MassSpringReference(scene)
    cloth.positions[1, 0, 1] -= 0.05
    trajectory = []
    for _ in range(200):
        trajectory.append(-0.5 - cloth.positions[1, 0, 1])
        cloth.step()
    phase = np.arccos(1.0 - 100.0 / 0.1 * 0.01**2 / 2.0)
    steps = np.arange(200)
    first = 0.05 * (1.0 - 100.0 / 0.1 * 0.01**2)
    sine = (first - 0.05 * np.cos(phase)) / np.sin(phase)
    np.testing.assert_allclose(
        trajectory, 0.05 * np.cos(steps * phase) + sine * np.sin(steps * phase), atol=1e-12)


def test_pinned_nodes_stay():
    """A pinned node moves, or a free one does not."""
    scene = Scene({**SPRINGS, 'rows': 4, 'cols': 3, 'pins': ['top_edge', '2,1'], 'dt': 0.002})
    cloth = MassSpringReference(scene)
    cloth.advance(0.3)
    pinned = scene.pinned_nodes()
    np.testing.assert_array_equal(cloth.positions[pinned], scene.rest_positions()[pinned])
    assert np.all(cloth.positions[~pinned] != scene.rest_positions()[~pinned])


def test_substeps_are_smaller_steps():
    """Two substeps of 2 ms are not the same as two steps of 2 ms."""
    values = {'rows': 4, 'cols': 4, 'auto_substeps': False,
              'pushes.start': [0.05], 'pushes.duration': [0.1],
              'pushes.force': [0.0, 0.1, 1.0]}
    split = MassSpringReference(Scene({**SPRINGS, **values, 'dt': 0.004, 'substeps': 2}))
    plain = MassSpringReference(Scene({**SPRINGS, **values, 'dt': 0.002}))
    split.advance(0.4)
    plain.advance(0.4)
    np.testing.assert_allclose(split.positions, plain.positions, atol=1e-12)


def test_free_cloth_keeps_its_momentum():
    """Inner forces do not cancel: they are not equal and opposite along the spring."""
    scene = Scene({**SPRINGS, **FREE, 'rows': 5, 'cols': 4, 'dt': 0.001})
    cloth = MassSpringReference(scene)
    random = np.random.default_rng(4)
    cloth.positions += 0.03 * random.standard_normal(cloth.positions.shape)
    cloth.velocities += random.standard_normal(cloth.positions.shape)
    linear = cloth.velocities.sum(axis=(0, 1))
    angular = np.cross(cloth.positions, cloth.velocities).sum(axis=(0, 1))
    cloth.advance(1.0)
    np.testing.assert_allclose(cloth.velocities.sum(axis=(0, 1)), linear, atol=1e-12)
    np.testing.assert_allclose(
        np.cross(cloth.positions, cloth.velocities).sum(axis=(0, 1)), angular, atol=1e-12)


def test_undamped_energy_stays_and_its_ripple_shrinks_with_dt():
    """Energy drifts, or its error is not of first order in dt."""
    ripples = []
    for dt in (2e-3, 1e-3, 5e-4):
        cloth = MassSpringReference(Scene({
            **SPRINGS,
            'rows': 6, 'cols': 6, 'dt': dt, 'auto_substeps': False, 'stiffness.bend': 50.0,
            **{f'damping.{family}': 0.0 for family in ('structural', 'shear', 'bend')}}))
        start = cloth.energies().total
        worst = 0.0
        for _ in range(100):
            cloth.advance(0.01)
            worst = max(worst, abs(cloth.energies().total - start))
        ripples.append(worst / (0.2 * 9.81))
    assert ripples[0] < 0.02
    assert ripples[0] / ripples[1] > 1.5
    assert ripples[1] / ripples[2] > 1.5


def test_first_order_against_dop853():
    """The scheme converges to another motion than that of its forces, or at another rate."""
    values = {'rows': 8, 'cols': 8, 'auto_substeps': False,
              'stiffness.structural': 20.0, 'stiffness.shear': 20.0, 'stiffness.bend': 2.0}
    begin = MassSpringReference(Scene(values))
    exact = solve_ivp(
        begin.right_hand_side, (0.0, 0.25),
        np.concatenate((begin.positions.ravel(), begin.velocities.ravel())),
        method='DOP853', rtol=1e-10, atol=1e-11)
    target = exact.y[:begin.positions.size, -1].reshape(begin.positions.shape)
    errors = []
    for dt in (1e-3, 5e-4, 2.5e-4):
        cloth = MassSpringReference(Scene({**SPRINGS, **values, 'dt': dt}))
        cloth.advance(0.25)
        errors.append(np.sqrt(np.mean(np.sum((cloth.positions - target) ** 2, axis=-1))))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    print(f'measured {orders.round(3)} of 0.95 to 1.1 allowed: order against DOP853')
    assert np.all((orders > 0.95) & (orders < 1.1))
