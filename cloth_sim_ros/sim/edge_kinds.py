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

"""The six kinds of edges: which two nodes each joins, and where its numbers are stored."""

from dataclasses import dataclass

from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.stability import OFFSETS
import numpy as np

# Row and column of some nodes, as slices or as arrays of integers: what NumPy indexes by.
Index = tuple[slice, slice] | tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class EdgeKind:
    """
    The edges from each node (row, col) to the node (row + drow, col + dcol).

    :param number: place in the last axis of arrays that have a number for every edge; the first
        two axes are the row and column of the node it starts at
    :param family: structural, shear or bend
    """

    number: int
    family: str
    drow: int
    dcol: int

    def rest_length(self, scene: Scene) -> float:
        """Return the length at rest [m]."""
        dx, dy = scene.spacing
        return float(np.hypot(self.dcol * dx, self.drow * dy))

    def everywhere(self, rows: int, cols: int) -> tuple[Index, Index]:
        """Return the starts and the ends of all edges of a cloth."""
        height, width = max(rows - self.drow, 0), max(cols - abs(self.dcol), 0)
        left = max(-self.dcol, 0)
        return (
            np.s_[:height, left:left + width],
            np.s_[self.drow:self.drow + height, left + self.dcol:left + self.dcol + width])

    def starting_at(self, nodes: np.ndarray, rows: int, cols: int) -> np.ndarray:
        """Tell which ``nodes`` (n, 2) are the start of an edge of the cloth."""
        starts_inside = _are_inside(nodes, rows, cols)
        return starts_inside & _are_inside(nodes + (self.drow, self.dcol), rows, cols)

    def touching(self, nodes: np.ndarray, rows: int, cols: int) -> tuple[Index, Index]:
        """Return the starts and the ends of the edges with an end in ``nodes`` (n, 2)."""
        starts = np.concatenate([nodes, nodes - (self.drow, self.dcol)])
        row, col = starts[self.starting_at(starts, rows, cols)].T
        return (row, col), (row + self.drow, col + self.dcol)


def _are_inside(nodes: np.ndarray, rows: int, cols: int) -> np.ndarray:
    return np.all((nodes >= 0) & (nodes < (rows, cols)), axis=1)


# Along the row, along the column, the two diagonals, two along the row, two along the column.
EDGE_KINDS = tuple(
    EdgeKind(number, family, *offset) for number, (family, offset) in enumerate(
        (family, offset) for family in FAMILIES for offset in OFFSETS[family]))
