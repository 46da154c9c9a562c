# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What nodes, edges and lines have of the cells of a cloth, against a walk over the cells."""

from cloth_sim_ros.reference.cells import node_masses
from cloth_sim_ros.reference.cells import spring_shares
from cloth_sim_ros.sim.model.cells import Cells
from cloth_sim_ros.sim.model.cells import inverse_masses
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
import numpy as np
import pytest

RECTANGLE = np.ones((3, 4), dtype=bool)
HOLES = np.array([[1, 1, 0, 1, 1], [1, 0, 0, 1, 1], [1, 1, 1, 1, 0], [0, 1, 1, 1, 1]], dtype=bool)


class SceneOf:
    """As much of a scene as the reference asks for."""

    def __init__(self, cells):
        self.cells = cells
        self.rows, self.cols = (count + 1 for count in cells.present.shape)
        self.node_mass = 1.0


@pytest.fixture(params=[RECTANGLE, HOLES], ids=['rectangle', 'with holes'])
def cells(request):
    """Return a cloth."""
    return Cells(request.param)


def test_node_shares_add_up_to_the_cells(cells):
    """A cell would not give its mass to its corners, or give more."""
    np.testing.assert_array_equal(cells.node_shares, node_masses(SceneOf(cells)))
    assert cells.node_shares.sum() == cells.count == cells.present.sum()


@pytest.mark.parametrize('kind', EDGE_KINDS, ids=lambda kind: kind.name)
def test_edge_shares(cells, kind):
    """An edge would not have half of each cell beside it, or a diagonal all of its own."""
    np.testing.assert_array_equal(
        cells.edge_shares(kind), spring_shares(SceneOf(cells), kind.drow, kind.dcol))


@pytest.mark.parametrize('direction', [0, 1])
def test_line_shares(cells, direction):
    """A line would bend where there is no cloth beside both of its edges."""
    expected = spring_shares(SceneOf(cells), 2 * direction, 2 * (1 - direction))
    inner = cells.line_shares(direction)
    middles = inner[:, 1:-1] if direction == 0 else inner[1:-1]
    np.testing.assert_array_equal(middles, expected)
    assert inner.sum() == expected.sum()


def test_parts_are_exact_in_float32(cells):
    """Shaders would read other shares than Python has."""
    parts = cells.parts.astype(np.float32).astype(np.int64)
    np.testing.assert_array_equal(0.25 * (parts >> 16), cells.node_shares)
    for kind in EDGE_KINDS:
        starts, _ = kind.everywhere(*parts.shape)
        np.testing.assert_array_equal(
            0.5 * (parts[starts] >> 2 * kind.number & 3), cells.edge_shares(kind))
    for direction in range(2):
        np.testing.assert_array_equal(
            0.5 * (parts >> 12 + 2 * direction & 3), cells.line_shares(direction))
    np.testing.assert_array_equal(
        inverse_masses(cells.parts) * cells.node_shares, cells.node_shares > 0.0)
