# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The implicit step solved directly in float64: what the device's solution is held against."""

from cloth_sim_ros.reference.edges import Edges
from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.sim.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.edge_kinds import rest_lengths
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu


def direct_step(
        scene: Scene, law: EdgeLaw, positions: np.ndarray, velocities: np.ndarray) -> np.ndarray:
    """
    Return dv [m/s] of the step that ``law`` describes, (rows, cols, 3), by a sparse LU.

    It is the first solve of a cloth without tensions, so that there is no geometric mass term,
    with lengths foreseen along the edges alone.

    :param positions: (rows, cols, 3) [m]
    :param velocities: (rows, cols, 3) [m/s]
    """
    h = law.length
    x, v = (field.reshape(-1, 3).astype(float) for field in (positions, velocities))
    free = ~scene.pinned_nodes().ravel()
    edges = edges_of(scene, FAMILIES)
    directions = edges.directions(x)
    rates = edges.along(v, directions)
    tension, weight = _pull(scene, law, edges, edges.lengths(x) + h * rates, rates)
    jacobian = edges.jacobian(directions, len(x))[:, np.repeat(free, 3)]
    matrix = sparse.identity(jacobian.shape[1]) + jacobian.T @ sparse.diags(weight) @ jacobian
    right = h * np.tile(scene['gravity'], np.count_nonzero(free)) - h * (jacobian.T @ tension)
    change = np.zeros_like(x)
    change[free] = splu(matrix.tocsc()).solve(right).reshape(-1, 3)
    return change.reshape(positions.shape)


def _pull(
        scene: Scene, law: EdgeLaw, edges: Edges, lengths: np.ndarray,
        rates: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the tension over the node mass [m/s2] and the weight in the matrix of each edge."""
    family = np.array([FAMILIES.index(name) for name in edges.family], dtype=int)
    kind = _rest_kinds(scene, edges)
    stiffness, damping = (np.array(values)[kind] for values in (law.stiffness, law.damping))
    shortest, longest = (np.array(values)[family] for values in (law.shortest, law.longest))
    rest = edges.rest_length
    # 1 / E goes with the inverse of the rest length.
    limit_stiffness = law.limit_stiffness[0] * rest_lengths(scene)[0] / rest
    beyond = np.maximum(lengths - longest * rest, 0.0)
    has_lower = shortest > 0.0
    beyond[has_lower] += np.minimum(lengths - shortest * rest, 0.0)[has_lower]
    in_force = (beyond != 0.0) | (shortest == longest)
    tension = stiffness * (lengths - rest) + damping * rates + limit_stiffness * beyond
    slope = stiffness + in_force * limit_stiffness
    return tension, law.length * (law.length * slope + damping)


def _rest_kinds(scene: Scene, edges: Edges) -> np.ndarray:
    """Return the place of each edge in what has a value for every rest length."""
    kinds = np.zeros(len(edges), dtype=int)
    (first_row, first_col), (row, col) = (
        np.divmod(nodes, scene.cols) for nodes in (edges.first, edges.second))
    for kind in EDGE_KINDS:
        kinds[(abs(row - first_row) == abs(kind.drow)) & (
            abs(col - first_col) == abs(kind.dcol))] = kind.rest
    return kinds
