# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The forces on a cloth besides those of its edges: pushes, air and bending, in float64."""

from cloth_sim_ros.reference.cells import spring_shares
from cloth_sim_ros.sim.model.materials import of_direction
from cloth_sim_ros.sim.model.materials import WARP
from cloth_sim_ros.sim.model.materials import WEFT
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.scene import Scene
import numpy as np
from scipy import sparse


def push_weight(push: Push, begin: float, end: float) -> float:
    """
    Return the part of the time from ``begin`` to ``end`` that the push acts in, 0 to 1.

    Summed over steps, weight times step is the push's duration at any step length: a push
    sampled at the step times would give another impulse for each dt.
    """
    overlap = min(push.start + push.duration, end) - max(push.start, begin)
    return max(overlap, 0.0) / (end - begin)


def push_nodes(push: Push, positions: np.ndarray, free: np.ndarray) -> np.ndarray:
    """Return the free nodes in the push's region, bool (rows, cols)."""
    return free & push.contains(positions)


def push_acceleration(push: Push, nodes: np.ndarray, masses: np.ndarray) -> np.ndarray:
    """
    Return the acceleration at full weight [m/s2]: the total force over the mass of ``nodes``.

    :param nodes: (rows, cols) bool
    :param masses: (rows, cols) [kg]
    """
    if not nodes.any():
        return np.zeros((*nodes.shape, 3))
    share = np.asarray(push.force) / masses[nodes].sum()
    return nodes[..., None] * share


# Drag and friction of the air, float64: each triangle by the law, its force shared by mass.

# The corners of a cell and its two neighbours along the cell, by row and column: a cell is cut
# along both diagonals, so that it has four triangles of half the weight.
_CORNERS = (
    ((0, 0), (1, 0), (0, 1)), ((0, 1), (1, 1), (0, 0)),
    ((1, 0), (0, 0), (1, 1)), ((1, 1), (0, 1), (1, 0)))
# Triangles that an inner node has a part in.
_MOST_TRIANGLES = 12


def wind_at(scene: Scene, begin: float, end: float) -> np.ndarray:
    """Return the mean wind of ``scene`` from ``begin`` to ``end`` [s], (3,) [m/s]."""
    wind = np.array(scene['air.wind'])
    for gust in scene.gusts():
        blows = min(gust.start + gust.duration, end) - max(gust.start, begin)
        wind = wind + max(blows, 0.0) / (end - begin) * np.array(gust.velocity)
    return wind


def air_forces(
        scene: Scene, positions: np.ndarray, velocities: np.ndarray,
        wind: np.ndarray) -> np.ndarray:
    """
    Return the force of the air on each node [N], (rows, cols, 3), pinned ones too.

    A triangle of area A, whose normal is n, feels rho A / 2 (Cn abs(wn) wn + Ct abs(wt) wt), where
    wn is the part along n of the wind less the velocity of the triangle, and wt the rest.

    Nodes of equal mass have equal areas, and spread them over their triangles: one at a border,
    which has half as many, counts twice in each, and one at a corner four times. A triangle moves
    and takes its force by these counts. In a cloth of cells each node counts once, and has a third
    of its triangles.

    :param positions: (rows, cols, 3) [m]
    :param velocities: (rows, cols, 3) [m/s]
    :param wind: (3,) [m/s]
    """
    forces = np.zeros_like(positions)
    if not scene.has_air:
        return forces
    counts = np.ones((scene.rows, scene.cols))
    if scene.cells is None:
        counts[[0, -1]] *= 2.0
        counts[:, [0, -1]] *= 2.0
        is_cell = np.ones((scene.rows - 1, scene.cols - 1))
    else:
        is_cell = scene.cells.present.astype(float)
    density = 0.5 * scene['air.density']
    # What a node's share is of the area of its twelfth parts of triangles of half a cell each.
    rest = 1.0 if scene.cells is not None else (
        scene['width'] * scene['height'] / scene.node_count / np.prod(scene.spacing))
    for corner, one, other in _CORNERS:
        nodes = [_part(corner), _part(one), _part(other)]
        total = counts[nodes[0]] + counts[nodes[1]] + counts[nodes[2]]
        moves = sum(counts[node][..., None] * velocities[node] for node in nodes)
        cross = np.cross(
            positions[nodes[1]] - positions[nodes[0]], positions[nodes[2]] - positions[nodes[0]])
        doubled = np.linalg.norm(cross, axis=-1, keepdims=True)
        normal = np.divide(cross, doubled, out=np.zeros_like(cross), where=doubled > 0.0)
        past = wind - moves / total[..., None]
        wn = np.sum(past * normal, axis=-1, keepdims=True) * normal
        wt = past - wn
        pressure = density * (scene['air.drag'] * _length(wn) * wn
                              + scene['air.friction'] * _length(wt) * wt)
        # The area that a node has in this triangle, if the node counts once.
        area = is_cell[..., None] * rest * doubled / _MOST_TRIANGLES
        for node in nodes:
            forces[node] += counts[node][..., None] * area * pressure
    return forces


def _part(offset: tuple[int, int]) -> tuple[slice, slice]:
    """Return where the nodes are that lie by ``offset`` from the first corner of each cell."""
    down, across = (slice(1, None) if step else slice(None, -1) for step in offset)
    return down, across


def _length(vectors: np.ndarray) -> np.ndarray:
    return np.linalg.norm(vectors, axis=-1, keepdims=True)


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
        # Second differences and chords of all lines of three nodes, along rows, then columns.
        self._differences, self._chords = (
            sparse.vstack((
                sparse.kron(sparse.identity(scene.rows), _of_lines(parts, scene.cols)),
                sparse.kron(_of_lines(parts, scene.rows), sparse.identity(scene.cols)))).tocsr()
            for parts in ((1.0, -2.0, 1.0), (-1.0, 0.0, 1.0)))
        # By the first node of each line, along rows, then columns.
        self._weights = np.concatenate((
            of_direction(rigidity, WARP) * dy / dx**3 * spring_shares(scene, 0, 2).ravel(),
            of_direction(rigidity, WEFT) * dx / dy**3 * spring_shares(scene, 2, 0).ravel()))
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
        """Return the bending energy [J]."""
        return -0.5 * float(np.sum(positions * self.forces(positions)))


def _of_lines(parts: tuple[float, float, float], count: int) -> sparse.csr_matrix:
    """Return the sum of three neighbours times ``parts``, for ``count`` nodes in a line."""
    if count < 3:
        return sparse.csr_matrix((0, count))
    return sparse.diags(parts, [0, 1, 2], shape=(count - 2, count), format='csr')
