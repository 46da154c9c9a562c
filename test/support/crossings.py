# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where the surface of a cloth passes through itself, by signs of volumes in float64."""

from fractions import Fraction

from cloth_sim_ros.sim.mesh import triangles
import numpy as np
from scipy.spatial import cKDTree


def crossings(positions: np.ndarray, present: np.ndarray | None = None) -> np.ndarray:
    """
    Return the edges that pierce triangles with which they share no node.

    :param positions: of the nodes [m], (rows, cols, 3); NaN where there is none
    :param present: which cells there are, (rows - 1, cols - 1) bool; None for all
    :return: both ends of the edge and the corners of the triangle, (n, 5) int
    """
    rows, cols = positions.shape[:2]
    x = positions.reshape(-1, 3).astype(float)
    faces = triangles(rows, cols, present).astype(int)
    edges = np.unique(np.sort(np.concatenate(
        [faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [0, 2]]]), axis=1), axis=0)
    middles, centres = x[edges].mean(axis=1), x[faces].mean(axis=1)
    reach = (
        np.linalg.norm(x[edges[:, 0]] - middles, axis=1).max()
        + np.linalg.norm(x[faces] - centres[:, None], axis=2).max())
    near = cKDTree(centres).query_ball_point(middles, reach)
    counts = np.array([len(each) for each in near])
    first = np.repeat(np.arange(len(edges)), counts)
    second = np.concatenate([np.array(each, dtype=int) for each in near])
    five = np.concatenate([edges[first], faces[second]], axis=1)
    is_apart = ~(five[:, :2, None] == five[:, None, 2:]).any(axis=(1, 2))
    five = five[is_apart]
    p, q, a, b, c = (x[five[:, k]] for k in range(5))
    below, above = _volume(a, b, c, p), _volume(a, b, c, q)
    around = np.stack([_volume(p, q, a, b), _volume(p, q, b, c), _volume(p, q, c, a)], axis=1)
    pierces = (below * above < 0.0) & (
        (around > 0.0).all(axis=1) | (around < 0.0).all(axis=1))
    # Triangles of a flat cloth have volumes that are 0, and rounding in float64.
    return five[[i for i in np.flatnonzero(pierces) if _pierces_exactly(x[five[i]])]]


def _pierces_exactly(points: np.ndarray) -> bool:
    """Return whether the edge of the first two of 5 points pierces the triangle of the others."""
    p, q, a, b, c = ([Fraction(each) for each in point] for point in points.tolist())
    below, above = _exact_volume(a, b, c, p), _exact_volume(a, b, c, q)
    around = [_exact_volume(p, q, *ends) for ends in ((a, b), (b, c), (c, a))]
    return below * above < 0 and (min(around) > 0 or max(around) < 0)


def _exact_volume(
        a: list[Fraction], b: list[Fraction], c: list[Fraction], d: list[Fraction]) -> Fraction:
    """Return six times the signed volume of a tetrahedron [m3]."""
    (ux, uy, uz), (vx, vy, vz), (wx, wy, wz) = (
        [end - begin for begin, end in zip(a, other)] for other in (b, c, d))
    return (
        (uy * vz - uz * vy) * wx + (uz * vx - ux * vz) * wy + (ux * vy - uy * vx) * wz)


def _volume(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> np.ndarray:
    """Return six times the signed volume of tetrahedra, (n,) [m3]."""
    return np.einsum('ij,ij->i', np.cross(b - a, c - a), d - a)
