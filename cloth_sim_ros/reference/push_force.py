# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A push as the scheme sees it: which nodes, and how much of each step."""

from cloth_sim_ros.sim.push import Push
import numpy as np


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


def push_acceleration(push: Push, nodes: np.ndarray, node_mass: float) -> np.ndarray:
    """Return the acceleration at full weight [m/s2]: the total force spread over ``nodes``."""
    share = np.asarray(push.force) / (max(int(nodes.sum()), 1) * node_mass)
    return nodes[..., None] * share
