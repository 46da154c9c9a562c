# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The longest stable step of a lattice as large as it is, with its edges and corners."""

import math

from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.stability import stability_limit
import numpy as np
from scipy import sparse
from scipy.optimize import brentq
from scipy.sparse.linalg import eigsh

_DENSE = 64
_TOLERANCE = 1e-4


def lattice_limit(scene: Scene) -> float:
    """
    Return the longest stable substep [s] of the flat cloth of ``scene``, nothing held.

    ``stability_limit`` has waves of an endless lattice in a closed form; this has the matrices of
    the springs themselves, K = J^T k J and C = J^T k_d J. A wave turns unstable by changing its
    sign in each step, so the limit is the least h at which h^2 K + 2 h C has the eigenvalue 4 m.
    """
    closed = stability_limit(scene)
    if math.isinf(closed):
        return closed
    edges = edges_of(scene)
    flat = scene.rest_positions().reshape(-1, 3)
    jacobian = edges.jacobian(edges.directions(flat), len(flat))
    stiff, damped = (
        jacobian.T @ sparse.diags(weights) @ jacobian
        for weights in (edges.stiffness, edges.damping))

    def excess(step: float) -> float:
        return _largest(step**2 * stiff + 2.0 * step * damped) / (4.0 * scene.node_mass) - 1.0

    # Edges and corners take springs away, so it is never below the closed form.
    longest = closed
    while excess(longest) < 0.0:
        longest *= 2.0
    return closed if longest == closed else float(
        brentq(excess, 0.5 * longest, longest, rtol=_TOLERANCE))


def _largest(matrix: sparse.spmatrix) -> float:
    if matrix.shape[0] < _DENSE:
        return float(np.linalg.eigvalsh(matrix.toarray())[-1])
    # A fixed start: the same scene gives the same figure.
    start = np.random.default_rng(0).uniform(-1.0, 1.0, matrix.shape[0])
    return float(eigsh(
        matrix, k=1, which='LA', tol=_TOLERANCE, v0=start, return_eigenvectors=False)[0])
