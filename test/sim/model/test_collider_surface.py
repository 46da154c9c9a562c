# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The lattice of a collider is its surface."""

from cloth_sim_ros.sim.model.collider_surface import collider_surface
from cloth_sim_ros.sim.model.collider_surface import ground
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.pose import unit_quaternion
import numpy as np
import pytest

TURN = unit_quaternion((0.3, -0.5, 0.2, 0.8), 'a turn')
R, L = 0.3, 0.5
# What their areas are by the formula; that of a plane is the square of twice the reach.
SHAPES = [
    ('plane', (), 4.0 * 0.7**2), ('sphere', (R,), 4.0 * np.pi * R**2),
    ('capsule', (R, L), 4.0 * np.pi * R**2 + 2.0 * np.pi * R * L),
    ('box', (0.2, 0.3, 0.5), 2.0 * (0.06 + 0.1 + 0.15)),
    ('cylinder', (R, L), 2.0 * np.pi * R * (R + L))]


def made(shape, size, position=(0.4, -0.2, 0.9), orientation=TURN):
    """Return a collider."""
    return Collider('body', shape, size, position, orientation, 0.3)


def cells(points):
    """Return two sides of both triangles of each cell: downwards and along, (2, rows, cols, 3)."""
    upper = points[1:, :-1] - points[:-1, :-1], points[:-1, 1:] - points[:-1, :-1]
    lower = points[1:, 1:] - points[:-1, 1:], points[1:, 1:] - points[1:, :-1]
    return np.stack([upper[0], lower[0]]), np.stack([upper[1], lower[1]])


@pytest.mark.parametrize(('shape', 'size', 'area'), SHAPES)
def test_points_are_on_the_surface_and_normals_point_away(shape, size, area):
    """A body would be drawn in another place than the cloth touches it, or be lit from inside."""
    body = made(shape, size)
    points, normals = collider_surface(body, np.array([0.5, 0.1, 1.0]), 0.7)
    np.testing.assert_allclose(body.distance(points.reshape(-1, 3)), 0.0, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=-1), 1.0)
    above = (points + 1e-3 * normals).reshape(-1, 3)
    np.testing.assert_allclose(body.distance(above), 1e-3, atol=1e-9)


@pytest.mark.parametrize(('shape', 'size', 'area'), SHAPES)
def test_it_is_closed_and_every_side_is_outside(shape, size, area):
    """A body would have a hole, or be seen from within."""
    points, normals = collider_surface(made(shape, size), reach=0.7)
    down, along = cells(points)
    faces = np.cross(down, along) / 2.0
    assert np.linalg.norm(faces, axis=-1).sum() == pytest.approx(area, rel=2e-3)
    outward = normals[:-1, :-1] + normals[1:, 1:] + normals[1:, :-1] + normals[:-1, 1:]
    assert (faces * outward).sum(axis=-1).min() > -1e-12
    if shape != 'plane':
        # The area vectors of a closed surface add up to 0.
        np.testing.assert_allclose(faces.sum(axis=(0, 1, 2)), 0.0, atol=1e-9)


def test_the_square_of_a_plane_is_next_to_the_point():
    """A plane far from its origin would not be below the cloth."""
    body = made('plane', ())
    around = np.array([7.0, 5.0, -3.0])
    points, _ = collider_surface(body, around, 0.5)
    foot = around - body.distance(around) * body.axes[2]
    np.testing.assert_allclose(points.mean(axis=(0, 1)), foot, atol=1e-9)


def test_the_ground_is_the_uppermost_level_plane():
    """The floor of a picture would be below the one that the cloth lies on, or be a ceiling."""
    def plane(height, orientation=(0.0, 0.0, 0.0, 1.0)):
        return made('plane', (), (0.0, 0.0, height), orientation)

    ceiling = plane(2.0, (1.0, 0.0, 0.0, 0.0))
    assert ground(()) is None
    assert ground((ceiling, plane(1.0, TURN), made('box', (1.0, 1.0, 1.0)))) is None
    assert ground((ceiling, plane(-0.3), plane(0.1), plane(-0.2))) == 0.1
