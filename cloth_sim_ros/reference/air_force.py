# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Drag and friction of the air, float64: each triangle by the law, its force shared by mass."""

from cloth_sim_ros.sim.scene import Scene
import numpy as np

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

    Each node stands for an equal share of mass and area, and spreads it over its triangles: one
    at a border, which has half as many, counts twice in each, and one at a corner four times. A
    triangle moves and takes its force by these counts.

    :param positions: (rows, cols, 3) [m]
    :param velocities: (rows, cols, 3) [m/s]
    :param wind: (3,) [m/s]
    """
    forces = np.zeros_like(positions)
    if not scene.has_air:
        return forces
    counts = np.ones((scene.rows, scene.cols))
    counts[[0, -1]] *= 2.0
    counts[:, [0, -1]] *= 2.0
    density = 0.5 * scene['air.density']
    # What a node's share is of the area of its twelfth parts of triangles of half a cell each.
    rest = scene['width'] * scene['height'] / scene.node_count / np.prod(scene.spacing)
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
        area = rest * doubled / _MOST_TRIANGLES
        for node in nodes:
            forces[node] += counts[node][..., None] * area * pressure
    return forces


def _part(offset: tuple[int, int]) -> tuple[slice, slice]:
    """Return where the nodes are that lie by ``offset`` from the first corner of each cell."""
    down, across = (slice(1, None) if step else slice(None, -1) for step in offset)
    return down, across


def _length(vectors: np.ndarray) -> np.ndarray:
    return np.linalg.norm(vectors, axis=-1, keepdims=True)
