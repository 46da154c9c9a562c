# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The forces on a cloth besides those of its edges: pushes, air and bending, in float64."""

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.reference.forces import air_forces
from cloth_sim_ros.reference.forces import push_nodes
from cloth_sim_ros.reference.forces import push_weight
from cloth_sim_ros.reference.forces import wind_at
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from springs import SPRINGS

PUSH = Push((0.0, 0.0, 2.0), start=0.05, duration=0.2)


@pytest.mark.parametrize(('begin', 'end', 'weight'), [
    (0.0, 0.05, 0.0), (0.0, 0.1, 0.5), (0.1, 0.2, 1.0), (0.2, 0.3, 0.5), (0.25, 0.3, 0.0),
    (0.0, 0.4, 0.5),
])
def test_weight_is_the_overlap(begin, end, weight):
    """A push counts more or less of a step than it acts in."""
    assert push_weight(PUSH, begin, end) == pytest.approx(weight)


@pytest.mark.parametrize('dt', [0.03, 0.017, 0.2, 0.5])
def test_impulse_is_exact_at_any_dt(dt):
    """The momentum given depends on dt."""
    scene = Scene({
        'rows': 3, 'cols': 4, 'dt': dt, 'auto_substeps': False, 'gravity': [0.0, 0.0, 0.0],
        'pins': ['top_left'],
        **{f'{kind}.{family}': 0.0 for kind in ('stiffness', 'damping')
           for family in ('structural', 'shear', 'bend')}})
    cloth = MassSpringReference(scene)
    cloth.push(PUSH)
    cloth.advance(1.0)
    momentum = scene.node_mass * cloth.velocities.sum(axis=(0, 1))
    np.testing.assert_allclose(momentum, [0.0, 0.0, 0.4], atol=1e-12)
    np.testing.assert_array_equal(cloth.velocities[0, 0], 0.0)


def test_sphere_takes_the_free_nodes_inside():
    """A push in a sphere reaches a pinned node, one outside, or misses one inside."""
    scene = Scene({'rows': 1, 'cols': 5, 'width': 4.0, 'pins': ['0,1'], 'start.z': 0.0})
    push = Push((1.0, 0.0, 0.0), 0.0, 1.0, 'sphere', (-1.0, 0.0, 0.0), 1.5)
    nodes = push_nodes(push, scene.rest_positions(), ~scene.pinned_nodes())
    assert nodes.tolist() == [[True, False, True, False, False]]


# The law of the air in the oracle, against formulas and scipy.

AIR = {**SPRINGS, 'rows': 6, 'cols': 9, 'width': 0.8, 'height': 0.5, 'air.density': 1.2,
       'air.drag': 1.1, 'air.friction': 0.05}


def rotation(chance):
    """Return a random rotation."""
    turn, _ = np.linalg.qr(chance.normal(size=(3, 3)))
    return turn * np.sign(np.linalg.det(turn))


def test_a_flat_sheet_in_any_attitude():
    """The force would not be that of its area, or normal and tangential parts mixed up."""
    chance = np.random.default_rng(0)
    scene = Scene(AIR)
    for _ in range(20):
        turn, wind = rotation(chance), chance.normal(size=3)
        forces = air_forces(
            scene, scene.rest_positions() @ turn.T, np.zeros((6, 9, 3)), wind)
        normal = turn[:, 2]
        across = (wind @ normal) * normal
        along = wind - across
        expected = 0.6 * 0.4 * (1.1 * np.linalg.norm(across) * across
                                + 0.05 * np.linalg.norm(along) * along)
        np.testing.assert_allclose(forces.sum(axis=(0, 1)), expected, rtol=1e-12)
        np.testing.assert_allclose(forces - forces.mean(axis=(0, 1)), 0.0, atol=1e-15)


def test_a_stretched_sheet_has_its_own_area():
    """A sheet that is stretched would feel the air as if it were not."""
    scene = Scene(AIR)
    forces = air_forces(
        scene, (1.3, 0.9, 1.0) * scene.rest_positions(), np.zeros((6, 9, 3)),
        np.array((0.0, 0.0, 3.0)))
    assert forces[..., 2].sum() == pytest.approx(0.6 * 1.1 * 9.0 * 0.4 * 1.3 * 0.9)


def test_a_cloth_without_area_feels_nothing():
    """Collapsed triangles would give NaN."""
    scene = Scene(AIR)
    forces = air_forces(
        scene, np.zeros((6, 9, 3)), np.zeros((6, 9, 3)), np.array((3.0, 2.0, 1.0)))
    assert not forces.any()


def test_still_air_takes_power_from_any_motion():
    """What a triangle feels would be spread otherwise than what it moves with."""
    chance = np.random.default_rng(1)
    scene = Scene(AIR)
    for _ in range(50):
        velocities = chance.normal(size=(6, 9, 3))
        forces = air_forces(
            scene, scene.rest_positions() + chance.normal(size=(6, 9, 3)) * 0.1, velocities,
            np.zeros(3))
        assert np.sum(forces * velocities) < 0.0


def test_wind_and_gusts():
    """A gust would come at another time than on the device."""
    scene = Scene({**SPRINGS, **AIR, 'air.wind': [1.0, 0.0, 0.0], 'gusts.start': [2.0],
                   'gusts.duration': [1.0], 'gusts.wind': [0.0, 4.0, 0.0]})
    np.testing.assert_allclose(wind_at(scene, 1.0, 2.0), (1.0, 0.0, 0.0))
    np.testing.assert_allclose(wind_at(scene, 2.5, 3.5), (1.0, 2.0, 0.0))


def test_it_comes_to_the_solution_in_continuous_time():
    """The scheme would come to another motion than that of the law, or with another order."""
    def error(dt):
        cloth = MassSpringReference(Scene({
            **SPRINGS,
            **AIR, 'rows': 5, 'cols': 5, 'air.wind': [2.0, 1.0, 3.0], 'dt': dt}), substeps=1)
        cloth.advance(0.2)
        start = MassSpringReference(cloth.scene)
        exact = solve_ivp(
            start.right_hand_side, (0.0, cloth.time),
            np.concatenate((start.positions.ravel(), start.velocities.ravel())),
            method='DOP853', rtol=1e-9, atol=1e-11).y[:, -1]
        return np.linalg.norm(cloth.positions.ravel() - exact[:75])

    coarse, fine = error(0.001), error(0.0005)
    assert 0.9 < np.log2(coarse / fine) < 1.1
