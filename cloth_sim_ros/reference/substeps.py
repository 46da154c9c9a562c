# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How many substeps an implicit step with frozen directions needs."""

import math

from cloth_sim_ros.reference.edges import Edges
import numpy as np

# Of the length, lost by an edge that turns in one substep: (omega h)^2 / 2.
TURN = 0.0025


def across_edges(edges: Edges, positions: np.ndarray, velocities: np.ndarray) -> np.ndarray:
    """Return the velocity of each edge's first end past its second, across the edge [m/s]."""
    return edges.across(velocities, edges.directions(positions))


def turn_substep(edges: Edges, positions: np.ndarray, velocities: np.ndarray) -> float:
    """
    Return the longest substep [s] in which no edge turns too far: (omega h)^2 / 2 <= TURN.

    One linear solve leaves an edge that turns at omega longer by that share, as its force acts
    along where the edge was.

    :param velocities: foreseen at the end of the step [m/s]
    """
    across = across_edges(edges, positions, velocities)
    omega = np.max(np.linalg.norm(across, axis=1) / edges.rest_length, initial=0.0)
    return math.sqrt(2.0 * TURN) / omega if omega > 0.0 else math.inf
