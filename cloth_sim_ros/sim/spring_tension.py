# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The tension of springs, by the law that the shaders step them with."""

from cloth_sim_ros.sim.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# As in spring_law.glsl: two nodes in one place are this far apart [m].
_LEAST_LENGTH = 1e-10


def spring_tension(
        scene: Scene, positions: np.ndarray, velocities: np.ndarray,
        nodes: np.ndarray | None = None) -> np.ndarray:
    """
    Return k (l - L0) + k_d dl/dt of every spring [N], (rows, cols, 6) float32; above 0 it pulls.

    It is as exact as the positions are: some 1e-7 of k times a coordinate.

    :param positions: (rows, cols, 3) [m]
    :param velocities: (rows, cols, 3) [m/s]
    :param nodes: (n, 2) rows and columns, for the springs at these nodes alone: the others are 0
    """
    tension = np.zeros((scene.rows, scene.cols, len(EDGE_KINDS)), dtype=np.float32)
    for kind in EDGE_KINDS:
        if not scene.models(kind.family):
            continue
        starts, ends = (
            kind.everywhere(scene.rows, scene.cols) if nodes is None
            else kind.touching(nodes, scene.rows, scene.cols))
        d = positions[ends].astype(float) - positions[starts]
        length = np.maximum(np.linalg.norm(d, axis=-1), _LEAST_LENGTH)
        rest = kind.rest_length(scene)
        stretch = length - rest
        pull = kind.stiffness(scene) * stretch
        if kind.damping(scene) > 0.0:
            dv = velocities[ends].astype(float) - velocities[starts]
            pull += kind.damping(scene) * np.sum(dv * d, axis=-1) / length
        tension[(*starts, kind.number)] = pull
    return tension
