# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Normals from positions."""

from cloth_sim_ros.rendering.surface_normals import surface_normals
import numpy as np


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
