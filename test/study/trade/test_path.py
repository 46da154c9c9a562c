# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Cloths of different resolution are compared at the same points."""

from cloth_sim_ros.study.trade.path import distances
from cloth_sim_ros.study.trade.path import Path
import numpy as np
import pytest


def plane(rows, cols, lift=0.0):
    """Return the path of a flat cloth that leans, at two times."""
    v, u = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1, cols), indexing='ij')
    positions = np.stack([u, v, 2.0 * u - 3.0 * v + lift], axis=-1)
    return Path(np.stack([positions, positions]), np.zeros(2), np.zeros((2, 3)))


@pytest.mark.parametrize('rows, cols', [(4, 9), (12, 3), (1, 5), (7, 7)])
def test_a_plane_is_the_same_at_any_resolution(rows, cols):
    """Nodes would be compared with points elsewhere on the cloth."""
    target = plane(7, 7)
    if rows > 1:
        assert distances(plane(rows, cols).on_nodes_of(7, 7), target).max() < 1e-12
    assert plane(7, 7).on_nodes_of(rows, cols).positions.shape == (2, rows, cols, 3)


def test_distance_is_that_of_the_same_nodes():
    """A shifted cloth would seem nearer or farther than it is."""
    assert distances(plane(5, 6, lift=0.25), plane(5, 6)) == pytest.approx([0.25, 0.25])
