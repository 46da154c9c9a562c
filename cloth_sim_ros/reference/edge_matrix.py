# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The matrix of an implicit step: a mass at each free node and a 3 x 3 block for each edge."""

from cloth_sim_ros.reference.edges import Edges
import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

# Below this many unknowns a dense solve is the quicker one.
DENSE = 60


class EdgeMatrix:
    """
    M plus, for each edge, a block K that resists what its ends move past one another.

    :param edges: between nodes
    :param free: which nodes can move, bool (nodes,)
    :param node_mass: [kg]
    """

    def __init__(self, edges: Edges, free: np.ndarray, node_mass: float) -> None:
        """Find where each number of each block goes; only free nodes have unknowns."""
        self.free = free
        self.size = 3 * int(np.count_nonzero(free))
        number = np.cumsum(free) - 1
        rows, cols, self._parts = [np.arange(self.size)], [np.arange(self.size)], []
        self._masses = np.full(self.size, node_mass)
        for one, other, sign in (
                (edges.first, edges.first, 1.0), (edges.second, edges.second, 1.0),
                (edges.first, edges.second, -1.0), (edges.second, edges.first, -1.0)):
            used = np.flatnonzero(free[one] & free[other])
            row = 3 * number[one[used]][:, None, None] + np.arange(3)[:, None]
            col = 3 * number[other[used]][:, None, None] + np.arange(3)
            row, col = np.broadcast_arrays(row, col)
            rows.append(row.ravel())
            cols.append(col.ravel())
            self._parts.append((used, sign))
        # Column by column, as the solver wants them; several numbers share a place.
        places, self._place = np.unique(
            np.concatenate(cols) * self.size + np.concatenate(rows), return_inverse=True)
        self._flat = places
        self._indices = places % max(self.size, 1)
        self._starts = np.searchsorted(places // max(self.size, 1), np.arange(self.size + 1))

    def solve(self, blocks: np.ndarray, right: np.ndarray) -> np.ndarray:
        """
        Return what solves (M + K) dv = ``right``, 0 at nodes that are not free.

        :param blocks: K of each edge, symmetric, (edges, 3, 3) [kg]
        :param right: (nodes, 3) [kg m/s]
        :return: dv (nodes, 3) [m/s]
        """
        change = np.zeros_like(right)
        if not self.size:
            return change
        numbers = np.concatenate(
            [self._masses, *(sign * blocks[used].ravel() for used, sign in self._parts)])
        data = np.bincount(self._place, numbers, len(self._flat))
        if self.size <= DENSE:
            dense = np.zeros(self.size**2)
            dense[self._flat] = data
            found = np.linalg.solve(
                dense.reshape(self.size, self.size), right[self.free].ravel())
        else:
            matrix = sparse.csc_matrix(
                (data, self._indices, self._starts), shape=(self.size, self.size))
            found = splu(
                matrix, permc_spec='MMD_AT_PLUS_A', diag_pivot_thresh=0.0,
                options={'SymmetricMode': True}).solve(right[self.free].ravel())
        change[self.free] = found.reshape(-1, 3)
        return change
