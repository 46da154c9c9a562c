# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Structural and shear edges in the order in which the sweeps of limit_sweep.comp take them."""

from cloth_sim_ros.reference.edges import Edges
from cloth_sim_ros.reference.limited_cloth import LIMITED
from cloth_sim_ros.sim.scene import Scene
import numpy as np

_COLOURS = 4
# Of the edges of a cell, in their order: along the row, along the column, the two diagonals.
_STEPS = ((0, 1), (1, 0), (1, 1), (1, -1))


def coloured_edges(scene: Scene, edges: Edges) -> list[np.ndarray]:
    """
    Return the numbers of the limited edges, in groups that share no node, in their order.

    A colour has the cells of one parity of column and row, and its groups one edge of each cell.
    """
    row, col = np.divmod(edges.first, scene.cols)
    down, right = edges.second // scene.cols - row, edges.second % scene.cols - col
    # The cell of an edge is at its upper left.
    cell_colour = np.minimum(col, col + right) % 2 + 2 * (row % 2)
    limited = edges.of(LIMITED)
    return [
        np.flatnonzero(limited & (cell_colour == colour) & (down == step[0]) & (right == step[1]))
        for colour in range(_COLOURS) for step in _STEPS]
