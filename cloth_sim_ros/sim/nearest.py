# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Find the node of a running cloth at a point."""

from collections.abc import Sequence

from cloth_sim_ros.sim.grid import near_node
from cloth_sim_ros.sim.grid import NearNode
from cloth_sim_ros.sim.scene import Scene
import numpy as np

USUAL_REACH = 0.1  # [m], as far as a click pushes


def nearest(
        scene: Scene, positions: np.ndarray, point: Sequence[float],
        max_distance: float | None = None, pinned: np.ndarray | None = None) -> NearNode:
    """
    Return the node nearest to ``point`` [m]; see near_node.

    :param max_distance: [m], by default usual_reach
    """
    if max_distance is None:
        max_distance = usual_reach(scene)
    return near_node(positions, point, max_distance, pinned)


def usual_reach(scene: Scene) -> float:
    """Return how far a node may be from a point that means it [m]: further on a coarse cloth."""
    dx, dy = scene.spacing
    return max(USUAL_REACH, dx if scene.cols > 1 else 0.0, dy if scene.rows > 1 else 0.0)
