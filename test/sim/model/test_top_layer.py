# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The highest layer near a point: one side of a fold, whatever lies beside or below it."""

from cloth_sim_ros.sim.model.top_layer import top_layer
from cloth_sim_ros.validation.layers import CELL
from cloth_sim_ros.validation.layers import layered_scene
from cloth_sim_ros.validation.layers import stacked
from cloth_sim_ros.validation.layers import THICKNESS
import numpy as np
import pytest

SIDE = 9


def rows_of(found: np.ndarray) -> list[int]:
    """Return the rows that have some of the nodes that were found."""
    return np.unique(np.nonzero(found)[0]).tolist()


@pytest.mark.parametrize('slope', [0.0, 0.5])
@pytest.mark.parametrize('rough', [0.0, 1e-5, 1e-3])
def test_highest_sheet_of_a_stack_is_found(slope, rough):
    """Sheets of a slope or with hems that stick out would be taken for one another."""
    scene = layered_scene(3, SIDE)
    # Hem on hem.
    places = stacked(scene, 3, (0.0, 0.0))
    places[..., :2] += rough * np.random.default_rng(1).standard_normal((*places.shape[:2], 2))
    places[..., 2] += slope * places[..., 0]
    for centre in ((0, 0), (4, 4), (0, 4)):
        point = places[2 * SIDE + centre[0], centre[1]]
        for reach in (0.3 * CELL, 1.2 * CELL, 3.0 * CELL):
            found = top_layer(places, point, reach, scene.cut_cells)
            near = np.linalg.norm(places - point, axis=-1) <= reach
            near[:2 * SIDE] = False
            np.testing.assert_array_equal(found, near)


def test_order_on_the_lattice_does_not_matter():
    """The first piece, or the last, would be taken for the highest."""
    scene = layered_scene(3, SIDE)
    places = stacked(scene, 3)[::-1].copy()
    places = np.concatenate([places[SIDE:], places[:SIDE]])
    found = top_layer(places, (0.08, -0.08, 2.0 * THICKNESS), 3.0 * CELL, scene.cut_cells)
    heights = places[found][:, 2]
    assert len(heights) > 10 and np.ptp(heights) < 1e-12 and heights[0] == places[..., 2].max()


def test_fold_within_reach_is_cut_in_two():
    """Both halves hang together at a fold, and would be taken at once."""
    side = 12
    row, col = np.indices((side, side))
    along = CELL * (row - 0.5 * (side - 1))
    # A fold of one cell, the upper half towards lower rows.
    places = np.stack([
        -np.abs(along), CELL * col, np.where(along < 0.0, THICKNESS, 0.0)], axis=-1)
    found = top_layer(places, (-0.03, 0.1, THICKNESS), 2.5 * CELL)
    assert rows_of(found) and max(rows_of(found)) < side // 2


def test_what_is_out_of_reach_covers_nothing():
    """A gripper below a canopy would find no cloth on the table."""
    scene = layered_scene(2, SIDE)
    places = stacked(scene, 2, apart=0.5)
    found = top_layer(places, places[4, 4], 1.5 * CELL, scene.cut_cells)
    assert rows_of(found) == [3, 4, 5]
    assert not top_layer(places, (9.0, 0.0, 0.0), 0.1, scene.cut_cells).any()


def test_nodes_below_the_middle_of_a_cell_are_not_found():
    """A small radius would reach through the layer on top, between its nodes."""
    scene = layered_scene(2, SIDE)
    places = stacked(scene, 2, (0.5, 0.5))
    below = places[4, 4]
    assert not top_layer(places, below, 0.2 * CELL, scene.cut_cells).any()


def test_chain_is_one_layer():
    """A chain has no faces, and no layer of it would be found."""
    places = np.zeros((1, SIDE, 3))
    places[0, :, 0] = CELL * np.arange(SIDE)
    assert top_layer(places, (0.0, 0.0, 0.0), 2.5 * CELL).sum() == 3
