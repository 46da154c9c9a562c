# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which nodes are drawn."""

from cloth_sim_ros.messages.surface import MOST_DRAWN
from cloth_sim_ros.messages.surface import Surface
from cloth_sim_ros.messages.surface import surface_bytes
from cloth_sim_ros.messages.triangles import triangles
import numpy as np
import pytest


def lattice(rows, cols):
    """Return positions that tell their node: (row, col, 0)."""
    row, col = np.mgrid[:rows, :cols]
    return np.stack([row, col, 0 * row], axis=-1).astype(np.float32)


def test_every_triangle_is_drawn():
    """The surface would miss cells or join nodes that are no neighbours."""
    surface = Surface(3, 4, max_side=256)
    points = surface.points(surface.sample(lattice(3, 4)))
    expected = lattice(3, 4).reshape(-1, 3)[triangles(3, 4).ravel()]
    assert points.dtype == np.float64
    np.testing.assert_array_equal(points, expected)


def test_colours_go_with_their_points():
    """A node's strain would show at another node."""
    surface = Surface(3, 4, max_side=256)
    colors = np.random.default_rng(1).random((3, 4, 4), dtype=np.float32)
    drawn = surface.colors(surface.sample(colors))
    np.testing.assert_array_equal(drawn, colors.reshape(-1, 4)[triangles(3, 4).ravel()])


def test_a_large_cloth_is_sampled_to_its_edges():
    """A large cloth would be drawn smaller than it is, or in messages of hundreds of MB."""
    surface = Surface(100, 30, max_side=10)
    points = surface.points(surface.sample(lattice(100, 30)))
    assert len(points) == 6 * 9 * 9
    assert points.min(axis=0).tolist() == [0, 0, 0]
    assert points.max(axis=0).tolist() == [99, 29, 0]
    assert len(np.unique(points[:, 0])) == len(np.unique(points[:, 1])) == 10


@pytest.mark.parametrize(('rows', 'cols'), [(1, 300), (300, 1)])
def test_a_chain_is_drawn_node_by_node(rows, cols):
    """A chain, which has no triangles, would be invisible."""
    surface = Surface(rows, cols, max_side=256)
    assert surface.is_chain
    points = surface.points(surface.sample(lattice(rows, cols)))
    np.testing.assert_array_equal(points, lattice(rows, cols).reshape(-1, 3))


@pytest.mark.parametrize(('rows', 'cols'), [(1, 300), (300, 1), (3, 4), (300, 20)])
def test_its_size_is_known_beforehand(rows, cols):
    """The shared memory would be chosen for messages of another size."""
    surface = Surface(rows, cols, MOST_DRAWN)
    points = surface.points(surface.sample(lattice(rows, cols)))
    colors = surface.colors(surface.sample(np.zeros((rows, cols, 4), np.float32)))
    assert surface_bytes(rows, cols) == points.nbytes + colors.nbytes
