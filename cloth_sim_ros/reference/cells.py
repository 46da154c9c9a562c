# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What nodes, springs and lines of bending have of the cells of a cloth, cell by cell."""

from cloth_sim_ros.sim.scene import Scene
import numpy as np


def node_masses(scene: Scene) -> np.ndarray:
    """Return the mass of each node, (rows, cols) [kg]: each cell gives a quarter to a corner."""
    masses = np.full((scene.rows, scene.cols), scene.node_mass)
    if scene.cells is not None:
        masses[:] = 0.0
        for row, col in np.argwhere(scene.cells.present):
            masses[row:row + 2, col:col + 2] += 0.25 * scene.node_mass
    return masses


def spring_shares(scene: Scene, down: int, right: int) -> np.ndarray:
    """
    Return what the springs of a direction have of the stiffness of a whole line.

    A cell gives half of it to each of its sides, and all of it to its diagonals; two cells side
    by side give half of it to each of the springs, and lines of bending, along both.

    :return: by the first node of each spring, as SpringSet.ends has them
    """
    height, width = max(scene.rows - down, 0), max(scene.cols - abs(right), 0)
    if scene.cells is None:
        return np.ones((height, width))
    shares = np.zeros((height, width))
    is_cell = scene.cells.present
    for row, col in np.argwhere(is_cell):
        if down and right:
            shares[row, col] += 1.0
        elif down == 1 or right == 1:
            shares[row, col] += 0.5
            shares[row + right, col + down] += 0.5
        elif row + down - 1 < len(is_cell) and col + right - 1 < is_cell.shape[1]:
            if is_cell[row + down // 2, col + right // 2]:
                shares[row, col] += 0.5
                shares[row + right // 2, col + down // 2] += 0.5
    return shares
