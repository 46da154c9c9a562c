# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Bending as one constant matrix: second differences along rows and columns, squared."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.springs import of_direction
from cloth_sim_ros.sim.springs import WARP
from cloth_sim_ros.sim.springs import WEFT
import numpy as np
from scipy import sparse


class Bending:
    """
    The quadratic energy of a bent cloth.

    :param scene: with its rigidity B of warp and weft [N m] and its cells
    """

    def __init__(self, scene: Scene) -> None:
        """Add up both directions."""
        dx, dy = scene.spacing
        rigidity = scene['bending.rigidity']
        along_row, along_column = _square(scene.cols), _square(scene.rows)
        # (nodes, nodes) [N/m], of nodes numbered row by row; forces are -matrix @ positions.
        self.matrix = (
            of_direction(rigidity, WARP) * dy / dx**3
            * sparse.kron(sparse.identity(scene.rows), along_row)
            + of_direction(rigidity, WEFT) * dx / dy**3
            * sparse.kron(along_column, sparse.identity(scene.cols))).tocsr()
        # Without rigidity there is nothing in it.
        self.matrix.eliminate_zeros()

    def forces(self, positions: np.ndarray) -> np.ndarray:
        """Return the force on each node [N]; both are (rows, cols, 3)."""
        return -(self.matrix @ positions.reshape(-1, 3)).reshape(positions.shape)

    def energy(self, positions: np.ndarray) -> float:
        """Return what the bent cloth stores [J]."""
        return -0.5 * float(np.sum(positions * self.forces(positions)))


def _square(count: int) -> sparse.csr_matrix:
    """Return D^T D, D the second differences of ``count`` nodes in a line."""
    if count < 3:
        return sparse.csr_matrix((count, count))
    differences = sparse.diags(
        [1.0, -2.0, 1.0], [0, 1, 2], shape=(count - 2, count), format='csr')
    return differences.T @ differences
