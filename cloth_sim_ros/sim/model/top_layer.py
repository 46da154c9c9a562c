# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which nodes near a point are of the highest layer of cloth there."""

from collections.abc import Sequence

from cloth_sim_ros.sim.mesh import triangles
import numpy as np


def top_layer(
        positions: np.ndarray, centre: Sequence[float], reach: float,
        present: np.ndarray | None = None) -> np.ndarray:
    """
    Return which nodes within ``reach`` are of the highest layer, (rows, cols) bool.

    A layer is what the edges of the lattice join within reach. The highest one has the smallest
    part of its nodes below other layers, and of equal ones the largest mean height. Its nodes
    that have cloth above them within reach, as beside a fold, are left out.

    :param positions: (rows, cols, 3) [m], NaN where there is no node
    :param centre: [m]
    :param reach: distance from ``centre`` [m]
    :param present: which cells there are, (rows - 1, cols - 1) bool; None for all
    """
    rows, cols = positions.shape[:2]
    places = positions.reshape(-1, 3).astype(float)
    is_near = np.linalg.norm(places - np.array(centre), axis=-1) <= reach
    faces = triangles(rows, cols, present).astype(int)
    layer = _layers(is_near, faces, min(rows, cols) == 1)
    nodes, under = _covered(places, is_near, faces, np.array(centre), reach)
    found = np.zeros(rows * cols, dtype=bool)
    if not is_near.any():
        return found.reshape(rows, cols)
    is_covered = np.zeros(rows * cols, dtype=bool)
    is_covered[nodes] = True
    is_below_another = np.zeros(rows * cols, dtype=bool)
    is_below_another[nodes[(layer[faces[under]] != layer[nodes, None]).all(axis=1)]] = True

    def depth(number: int) -> tuple[float, float]:
        own = layer == number
        return float(is_below_another[own].mean()), -float(places[own, 2].mean())

    highest = min(range(layer.max() + 1), key=depth)
    found[(layer == highest) & ~is_covered] = True
    return found.reshape(rows, cols)


def _layers(is_near: np.ndarray, faces: np.ndarray, is_chain: bool) -> np.ndarray:
    """Return the number of the layer of each node, -1 for those that are not near, (nodes,)."""
    # Imported here: few runs need it.
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    numbers = np.arange(len(is_near))
    edges = np.stack([numbers[:-1], numbers[1:]], axis=1) if is_chain else np.concatenate(
        [faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges = edges[is_near[edges].all(axis=1)]
    links = coo_array((np.ones(len(edges)), tuple(edges.T)), shape=(len(is_near),) * 2)
    _, joined = connected_components(links, directed=False)
    layer = np.full(len(is_near), -1)
    layer[is_near] = np.unique(joined[is_near], return_inverse=True)[1]
    return layer


def _covered(
        places: np.ndarray, is_near: np.ndarray, faces: np.ndarray, centre: np.ndarray,
        reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Return nodes that are near and the faces that lie above them within reach, (pairs,) each."""
    from scipy.spatial import cKDTree
    corners = places[faces]
    is_there = np.isfinite(corners).all(axis=(1, 2))
    is_there &= (corners.min(axis=1) <= centre + reach).all(axis=-1)
    is_there &= (corners.max(axis=1) >= centre - reach).all(axis=-1)
    there, nodes = np.flatnonzero(is_there), np.flatnonzero(is_near)
    if not len(there) or not len(nodes):
        return np.zeros(0, dtype=int), np.zeros(0, dtype=int)
    middles = corners[there, :, :2].mean(axis=1)
    size = np.linalg.norm(corners[there, :, :2] - middles[:, None], axis=-1).max()
    beside = cKDTree(middles).query_ball_point(places[nodes, :2], size)
    nodes = np.repeat(nodes, [len(each) for each in beside])
    under = there[np.concatenate([np.array(each, dtype=int) for each in beside])]
    is_other = (faces[under] != nodes[:, None]).all(axis=1)
    nodes, under = nodes[is_other], under[is_other]
    # Weights of the corners where the vertical through the node meets the face.
    a, b, c = np.moveaxis(places[faces[under]] - places[nodes, None], 1, 0)
    weights = np.stack([_area(b, c), _area(c, a), _area(a, b)], axis=1)
    total = weights.sum(axis=1)
    is_inside = (total != 0.0) & ((weights * total[:, None]) >= 0.0).all(axis=1)
    nodes, under, weights = nodes[is_inside], under[is_inside], weights[is_inside]
    weights /= weights.sum(axis=1, keepdims=True)
    hits = np.einsum('ij,ijk->ik', weights, places[faces[under]])
    is_above = (hits[:, 2] > places[nodes, 2]) & (
        np.linalg.norm(hits - centre, axis=1) <= reach)
    return nodes[is_above], under[is_above]


def _area(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return twice the signed area between vectors seen from above, (n,) [m2]."""
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
