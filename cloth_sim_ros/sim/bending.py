# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Bending of a cloth as of a sheet, linear in positions; see docs/explanation/numerics.md.

Three nodes in a line, a apart, have the curvature D / a^2 with D = x[i-1] - 2 x[i] + x[i+1]. In
cells of dx x dy, a sheet of the rigidity B [N m] stores c / 2 D^2 at each of them, with
c = B dy / dx^3 along a row and B dx / dy^3 along a column. So the fourth difference of positions
is the force, and the grid does not matter. Springs between nodes two places apart (the bend
springs) have no such limit: on a flat cloth they do not resist at all, to first order.
"""

from cloth_sim_ros.sim.scene import Scene
import numpy as np

# A node's part in D of a line around the node at this place.
_PARTS = {-1: 1.0, 0: -2.0, 1: 1.0}


def bending_pulls(scene: Scene, positions: np.ndarray, nodes: np.ndarray) -> np.ndarray:
    """
    Return what bending pulls ``nodes`` with [N], (n, 3) float64.

    :param positions: (rows, cols, 3) [m]
    :param nodes: rows and columns, (n, 2) int
    """
    pulls = np.zeros((len(nodes), 3))
    for c, by in zip(scene.bending, ((0, 1), (1, 0))):
        for place, part in _PARTS.items():
            centres = nodes + np.array(by) * place
            lines = np.stack([centres - by, centres, centres + by])
            are_there = np.all((lines >= 0) & (lines < (scene.rows, scene.cols)), axis=(0, 2))
            behind, here, ahead = (
                positions[tuple(line[are_there].T)].astype(float) for line in lines)
            pulls[are_there] -= c * part * ((behind - here) + (ahead - here))
    return pulls
