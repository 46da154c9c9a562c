# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Bending as one constant matrix: second differences along rows and columns, squared; damping."""

from cloth_sim_ros.sim.materials import of_direction
from cloth_sim_ros.sim.materials import WARP
from cloth_sim_ros.sim.materials import WEFT
from cloth_sim_ros.sim.scene import Scene
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
        self.damping: float = scene['bending.damping']  # [s]
        # Of each line of three nodes, along rows and then along columns.
        self._differences, self._chords = (
            sparse.vstack((
                sparse.kron(sparse.identity(scene.rows), _of_lines(parts, scene.cols)),
                sparse.kron(_of_lines(parts, scene.rows), sparse.identity(scene.cols)))).tocsr()
            for parts in ((1.0, -2.0, 1.0), (-1.0, 0.0, 1.0)))
        self._weights = np.repeat(
            (of_direction(rigidity, WARP) * dy / dx**3,
             of_direction(rigidity, WEFT) * dx / dy**3),
            (scene.rows * max(scene.cols - 2, 0), scene.cols * max(scene.rows - 2, 0)))
        # (nodes, nodes) [N/m], of nodes numbered row by row; forces are -matrix @ positions.
        self.matrix = (
            self._differences.T @ sparse.diags(self._weights) @ self._differences).tocsr()
        # Without rigidity there is nothing in it.
        self.matrix.eliminate_zeros()

    def forces(self, positions: np.ndarray) -> np.ndarray:
        """Return the force on each node [N]; both are (rows, cols, 3)."""
        return -(self.matrix @ positions.reshape(-1, 3)).reshape(positions.shape)

    def damping_matrix(self, positions: np.ndarray) -> sparse.csr_matrix | None:
        """
        Return what damping resists, (3 nodes, 3 nodes) [N s/m]; None for none.

        A line of three nodes is damped by how fast the part of its second difference D across the
        line grows, not by how the line is stretched or turns: a cloth rotates as freely as
        without. A line that is folded up counts for less, docs/explanation/numerics.md.
        """
        if not self.damping * self.matrix.nnz:
            return None
        flat = positions.reshape(-1, 3)
        bent, chord = self._differences @ flat, self._chords @ flat
        square = np.sum(chord**2, axis=1)
        skew = np.divide(
            np.sum(bent * chord, axis=1), square, out=np.zeros_like(square), where=square > 0.0)
        across = bent - skew[:, None] * chord
        lengths = np.linalg.norm(across, axis=1, keepdims=True) * np.sqrt(
            1.0 + skew[:, None]**2 / 3.0)
        across = np.divide(across, lengths, out=np.zeros_like(across), where=lengths > 0.0)
        lines = np.repeat(np.arange(len(bent)), 3)
        project = sparse.csr_matrix(
            (across.ravel(), (lines, np.arange(bent.size))), (len(bent), bent.size))
        growth = project @ sparse.kron(
            self._differences - sparse.diags(skew) @ self._chords, sparse.identity(3))
        return self.damping * (growth.T @ sparse.diags(self._weights) @ growth).tocsr()

    def damping_forces(self, positions: np.ndarray, velocities: np.ndarray) -> np.ndarray:
        """Return what damping does to each node [N]; all are (rows, cols, 3)."""
        matrix = self.damping_matrix(positions)
        if matrix is None:
            return np.zeros_like(velocities)
        return -(matrix @ velocities.ravel()).reshape(velocities.shape)

    def energy(self, positions: np.ndarray) -> float:
        """Return what the bent cloth stores [J]."""
        return -0.5 * float(np.sum(positions * self.forces(positions)))


def _of_lines(parts: tuple[float, float, float], count: int) -> sparse.csr_matrix:
    """Return the sum of three neighbours times ``parts``, for ``count`` nodes in a line."""
    if count < 3:
        return sparse.csr_matrix((0, count))
    return sparse.diags(parts, [0, 1, 2], shape=(count - 2, count), format='csr')
