# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The oracle's springs against plain loops and hand-made numbers."""

from cloth_sim_ros.reference.cloth import elastic_energy
from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.reference.edges import spring_sets
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest

NEIGHBOURS = {
    'structural': ((0, 1), (0, -1), (1, 0), (-1, 0)),
    'shear': ((1, 1), (1, -1), (-1, 1), (-1, -1)),
    'bend': ((0, 2), (0, -2), (2, 0), (-2, 0)),
}


def _scene(**values):
    return Scene({
        'rows': 4, 'cols': 5, 'width': 0.8, 'height': 0.3,
        'stiffness.structural': 90.0, 'stiffness.shear': 40.0, 'stiffness.bend': 7.0,
        'damping.structural': 0.3, 'damping.shear': 0.2, 'damping.bend': 0.1, **values})


def _random_state(scene, seed=1):
    random = np.random.default_rng(seed)
    shape = (scene.rows, scene.cols, 3)
    positions = scene.rest_positions() + 0.03 * random.standard_normal(shape)
    return positions, random.standard_normal(shape)


def _forces(scene, positions, velocities):
    flat = edges_of(scene).spring_forces(positions.reshape(-1, 3), velocities.reshape(-1, 3))
    return flat.reshape(positions.shape)


def _force_by_loops(scene, positions, velocities):
    dx, dy = scene.spacing
    forces = np.zeros_like(positions)
    for row in range(scene.rows):
        for col in range(scene.cols):
            for family, offsets in NEIGHBOURS.items():
                for down, right in offsets:
                    other = row + down, col + right
                    if not (0 <= other[0] < scene.rows and 0 <= other[1] < scene.cols):
                        continue
                    d = positions[row, col] - positions[other]
                    length = np.sqrt(d @ d)
                    rest = np.sqrt((dx * right) ** 2 + (dy * down) ** 2)
                    rate = (velocities[row, col] - velocities[other]) @ d / length
                    tension = (scene.stiffness(family) * (length - rest)
                               + scene.damping(family) * rate)
                    forces[row, col] -= tension * d / length
    return forces


@pytest.mark.parametrize(('rows', 'cols'), [(4, 5), (5, 4), (2, 3), (1, 6), (6, 1), (2, 2)])
def test_edges_are_the_12_neighbours(rows, cols):
    """Edges tie other nodes than the 12 neighbours, or with another rest length."""
    scene = _scene(rows=rows, cols=cols)
    positions, velocities = _random_state(scene)
    np.testing.assert_allclose(
        _forces(scene, positions, velocities),
        _force_by_loops(scene, positions, velocities), rtol=1e-12, atol=1e-12)


def test_one_stretched_spring():
    """The spring law does not give the force worked out by hand."""
    scene = Scene({'rows': 2, 'cols': 1, 'height': 1.0, 'stiffness.structural': 50.0,
                   'damping.structural': 0.5})
    positions = np.array([[[0.0, 0.0, 0.0]], [[0.0, -0.6, -0.8 - 0.0]]]) * 1.1
    velocities = np.array([[[0.0, 0.0, 0.0]], [[1.0, -0.6, -0.8]]])
    # 0.1 m of stretch at 50 N/m and 1 m/s of it at 0.5 N s/m: 5.5 N back along (0, 0.6, 0.8).
    forces = _forces(scene, positions, velocities)
    np.testing.assert_allclose(forces[1, 0], [0.0, 3.3, 4.4], atol=1e-12)
    np.testing.assert_allclose(forces[0, 0], [0.0, -3.3, -4.4], atol=1e-12)


def test_no_force_at_rest():
    """Springs pull in the start pose: a rest length is not the lattice's."""
    for pose in ('horizontal', 'hanging'):
        scene = _scene(**{'start.pose': pose})
        rest = scene.rest_positions()
        assert np.abs(_forces(scene, rest, np.zeros_like(rest))).max() < 1e-12


def test_force_is_the_slope_of_the_elastic_energy():
    """Force and elastic energy belong to two different springs."""
    scene = _scene()
    springs = spring_sets(scene)
    positions, _ = _random_state(scene)
    forces = _forces(scene, positions, np.zeros_like(positions))
    step = 1e-6
    for index in ((0, 0, 0), (1, 2, 1), (3, 4, 2), (2, 1, 2)):
        moved = positions.copy()
        moved[index] += step
        above = elastic_energy(springs, moved)
        moved[index] -= 2.0 * step
        slope = (above - elastic_energy(springs, moved)) / (2.0 * step)
        assert forces[index] == pytest.approx(-slope, rel=1e-6, abs=1e-6)


def test_damping_leaves_rigid_motion_alone():
    """Damping brakes a rotation or a flight of the whole cloth: it is not along the spring."""
    scene = _scene()
    positions, _ = _random_state(scene)
    spin = np.cross([0.4, -1.0, 2.0], positions) + [3.0, 2.0, 1.0]
    np.testing.assert_allclose(
        _forces(scene, positions, spin),
        _forces(scene, positions, np.zeros_like(spin)), atol=1e-10)


def test_a_spring_without_length_does_nothing():
    """Two nodes in one place give NaN."""
    scene = Scene({'rows': 1, 'cols': 2})
    together = np.zeros((1, 2, 3))
    forces = _forces(scene, together, np.ones((1, 2, 3)))
    np.testing.assert_array_equal(forces, 0.0)
