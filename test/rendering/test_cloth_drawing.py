# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The surface is drawn where the nodes are, with the normals of a cloth."""

from cloth_sim_ros.rendering.cloth_drawing import cell_sides
from cloth_sim_ros.rendering.cloth_drawing import surface_normals
import numpy as np
import pytest


def test_a_flat_cloth_has_its_front_up():
    """Front and back of a state file would be swapped against a recording."""
    positions = np.zeros((4, 5, 3))
    positions[..., 0] = np.arange(5)
    positions[..., 1] = -np.arange(4)[:, None]
    np.testing.assert_allclose(surface_normals(positions), np.broadcast_to((0, 0, 1), (4, 5, 3)))


def test_a_cylinder_has_its_radii():
    """Folds would be lit from elsewhere."""
    angle = np.linspace(0.0, 1.5, 40)
    positions = np.zeros((6, 40, 3))
    positions[..., 0], positions[..., 2] = np.sin(angle), np.cos(angle)
    positions[..., 1] = -np.arange(6)[:, None]
    radii = positions * (1.0, 0.0, 1.0)
    np.testing.assert_allclose(surface_normals(positions)[:, 1:-1], radii[:, 1:-1], atol=1e-3)


def test_a_cloth_without_area_is_no_failure():
    """A chain, or a crumpled state, would be drawn with NaN."""
    assert np.isfinite(surface_normals(np.zeros((3, 4, 3)))).all()
    assert np.isfinite(surface_normals(np.random.default_rng(0).normal(size=(1, 9, 3)))).all()


def lattice(width, height):
    """Return the positions of a flat cloth with cells of this size."""
    positions = np.zeros((5, 7, 3))
    positions[..., 0] = np.arange(7) * width
    positions[..., 1] = np.arange(5)[:, None] * height
    return positions


@pytest.mark.parametrize(('width', 'height', 'sides'), [
    (0.1, 0.1, (1.0, 1.0)), (0.3, 0.1, (3.0, 1.0)), (0.1, 0.2, (1.0, 2.0)), (0, 0, (1.0, 1.0))])
def test_it_is_that_of_the_cloth(width, height, sides):
    """Dots would be ellipses, or a cloth in one point divide by zero."""
    assert cell_sides(lattice(width, height)) == pytest.approx(sides)
