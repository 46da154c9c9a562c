# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The matrix of an implicit step: masses, a 3 x 3 block for each edge, and bending."""

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
    :param bending: what it resists, (nodes, nodes), which counts the same in x, y and z
    """

    def __init__(
            self, edges: Edges, free: np.ndarray, node_mass: float,
            bending: sparse.spmatrix | None = None) -> None:
        """Find where each number of each block goes; only free nodes have unknowns."""
        self.free = free
        self._own = np.repeat(free, 3)
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
        tied = sparse.coo_matrix((0, 0)) if bending is None else (
            bending.tocsr()[free][:, free].tocoo())
        for axis in range(3):
            rows.append(3 * tied.row.astype(int) + axis)
            cols.append(3 * tied.col.astype(int) + axis)
        self._bending = np.tile(tied.data, 3)
        # Column by column, as the solver wants them; several numbers share a place.
        places, self._place = np.unique(
            np.concatenate(cols) * self.size + np.concatenate(rows), return_inverse=True)
        self._flat = places
        self._indices = places % max(self.size, 1)
        self._starts = np.searchsorted(places // max(self.size, 1), np.arange(self.size + 1))

    def solve(
            self, blocks: np.ndarray, right: np.ndarray, share: float = 0.0,
            more: sparse.csr_matrix | None = None) -> np.ndarray:
        """
        Return what solves (M + K + K_bend + ``more``) dv = ``right``, 0 where it is not free.

        :param blocks: K of each edge, symmetric, (edges, 3, 3) [kg]
        :param right: (nodes, 3) [kg m/s]
        :param share: of the matrix of bending in K_bend [s2]
        :param more: (3 nodes, 3 nodes) [kg]; None for none
        :return: dv (nodes, 3) [m/s]
        """
        change = np.zeros_like(right)
        if not self.size:
            return change
        numbers = np.concatenate(
            [self._masses, *(sign * blocks[used].ravel() for used, sign in self._parts),
             share * self._bending])
        data = np.bincount(self._place, numbers, len(self._flat))
        if self.size <= DENSE:
            dense = np.zeros((self.size, self.size))
            dense.ravel()[self._flat] = data
            if more is not None:
                dense += more[self._own][:, self._own].toarray()
            found = np.linalg.solve(dense, right[self.free].ravel())
        else:
            matrix = sparse.csc_matrix(
                (data, self._indices, self._starts), shape=(self.size, self.size))
            if more is not None:
                matrix = (matrix + more[self._own][:, self._own]).tocsc()
            found = splu(
                matrix, permc_spec='MMD_AT_PLUS_A', diag_pivot_thresh=0.0,
                options={'SymmetricMode': True}).solve(right[self.free].ravel())
        change[self.free] = found.reshape(-1, 3)
        return change
