# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
A cloth as a set of cells: the parts of cells that belong to nodes, edges and bending lines.

A cell gives a quarter of its mass to each of its corners, half of its stiffness to each of its
sides, and all of it to its diagonals. Two cells side by side give half of theirs to the lines of
three nodes along them. So an edge at a border has half the stiffness of one inside, and a node at
a corner a quarter of the mass, and the same fabric is the same cloth on any grid.
"""

from dataclasses import dataclass
from functools import cached_property

from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.model.edge_kinds import EdgeKind
from cloth_sim_ros.sim.model.edge_kinds import Index
import numpy as np

# Bits of the field of an edge or a line in the parts of a node [1]: it counts halves, up to 2.
_FIELD_BITS = 2
_MOST_HALVES = 2**_FIELD_BITS - 1
# First bit of the lines of bending, and of the quarters of a cell's mass [1]; cells.glsl has them.
_LINES_AT = _FIELD_BITS * len(EDGE_KINDS)
_QUARTERS_AT = _LINES_AT + 2 * _FIELD_BITS


@dataclass(frozen=True, eq=False)
class Cells:
    """
    Which cells of a lattice there are.

    :param present: (rows - 1, cols - 1) bool
    """

    present: np.ndarray

    @property
    def count(self) -> int:
        """Return how many there are."""
        return int(self.present.sum())

    @cached_property
    def node_shares(self) -> np.ndarray:
        """Return the mass of each node over that of a cell, 0 where there is none."""
        quarters = self._around.sum(axis=0, dtype=np.int32)
        return 0.25 * quarters

    def edge_shares(self, kind: EdgeKind) -> np.ndarray:
        """Return the stiffness of each edge over that of a whole line, at its starts."""
        rows, cols = self.node_shares.shape
        starts, _ = kind.everywhere(rows, cols)
        return 0.5 * self._halves(kind)[starts]

    def line_shares(self, direction: int) -> np.ndarray:
        """
        Return the rigidity of each line of three nodes over that of a whole line.

        :param direction: WARP for lines along rows, WEFT for those along columns
        :return: (rows, cols), at the middle of the line
        """
        return 0.5 * self._line_halves(direction)

    def edge_shares_at(self, starts: Index, numbers: np.ndarray) -> np.ndarray:
        """Return the shares of some edges, by their starts and the numbers of their kinds."""
        return 0.5 * (self.parts[starts] >> _FIELD_BITS * numbers & _MOST_HALVES)

    def line_shares_at(self, middles: Index, direction: int) -> np.ndarray:
        """Return the shares of some lines, by the nodes in their middle; as ``line_shares``."""
        return 0.5 * (
            self.parts[middles] >> _LINES_AT + _FIELD_BITS * direction & _MOST_HALVES)

    @cached_property
    def parts(self) -> np.ndarray:
        """Return all of these as bits, as shaders have them, (rows, cols) int32."""
        parts = np.zeros(self.node_shares.shape, dtype=np.int32)
        for kind in EDGE_KINDS:
            parts |= self._halves(kind) << _FIELD_BITS * kind.number
        for direction in range(2):
            parts |= self._line_halves(direction) << _LINES_AT + _FIELD_BITS * direction
        return parts | np.rint(4.0 * self.node_shares).astype(np.int32) << _QUARTERS_AT

    @cached_property
    def _around(self) -> np.ndarray:
        """Return the cells up left, up right, down left, down right of each node, (4, ...)."""
        padded = np.pad(self.present, 1)
        return np.stack([padded[:-1, :-1], padded[:-1, 1:], padded[1:, :-1], padded[1:, 1:]])

    def _line_halves(self, direction: int) -> np.ndarray:
        up_left, up_right, down_left, down_right = self._around
        one, other = (
            (up_left & up_right, down_left & down_right) if direction == 0
            else (up_left & down_left, up_right & down_right))
        return one.astype(np.int32) + other

    def _halves(self, kind: EdgeKind) -> np.ndarray:
        """Return the shares of the edges that start at each node, in halves, (rows, cols)."""
        _, up_right, down_left, down_right = self._around
        if kind.name == 'row':
            return up_right.astype(np.int32) + down_right
        if kind.name == 'column':
            return down_left.astype(np.int32) + down_right
        if kind.family == 'shear':
            return 2 * (down_right if kind.dcol > 0 else down_left).astype(np.int32)
        # A bend edge joins the ends of the line around the node between them.
        lines = self._line_halves(kind.direction)
        halves = np.zeros_like(lines)
        drow, dcol = kind.drow // 2, kind.dcol // 2
        halves[:len(lines) - drow, :lines.shape[1] - dcol] = lines[drow:, dcol:]
        return halves


def present_nodes(present: np.ndarray) -> np.ndarray:
    """Return the nodes of these cells: (rows - 1, cols - 1) bool to (rows, cols) bool."""
    return Cells(present).node_shares > 0.0


def edge_shares(cells: Cells | None, kind: EdgeKind) -> np.ndarray | float:
    """Return those of ``cells``, or 1 for a cloth of whole lines."""
    return 1.0 if cells is None else cells.edge_shares(kind)


def inverse_masses(parts: np.ndarray) -> np.ndarray:
    """Return the inverse masses of nodes of these ``parts``, 0 where there is none."""
    quarters = parts.astype(np.int32) >> _QUARTERS_AT
    # Nodes of equal mass have no quarters.
    return np.divide(4.0, quarters, out=(parts > 0).astype(float), where=quarters > 0)
