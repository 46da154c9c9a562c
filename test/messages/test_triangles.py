# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The faces of the lattice."""

from cloth_sim_ros.messages.triangles import triangles
from cloth_sim_ros.sim.scene import Scene
import numpy as np


def test_each_cell_is_covered_once():
    """The surface would have holes or overlap."""
    rows, cols = 4, 6
    positions = Scene({'rows': rows, 'cols': cols, 'width': 5.0, 'height': 3.0}).rest_positions()
    corners = positions.reshape(-1, 3)[triangles(rows, cols)]
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    np.testing.assert_allclose(area, np.tile([0.0, 0.0, 0.5], (2 * 3 * 5, 1)), atol=1e-12)
    cells = np.floor(corners.mean(axis=1)[:, :2] - positions[-1, 0, :2])
    assert sorted(map(tuple, cells)) == sorted(
        2 * [(float(col), float(row)) for row in range(3) for col in range(5)])


def test_a_chain_has_no_faces():
    """A chain would be drawn with faces of nothing."""
    assert triangles(1, 9).shape == triangles(9, 1).shape == (0, 3)
