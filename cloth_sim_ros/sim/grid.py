# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where the nodes of the lattice lie at rest."""

import numpy as np


def spacing(rows: int, cols: int, width: float, height: float) -> tuple[float, float]:
    """Return the rest distance along a row and along a column [m]."""
    return width / max(cols - 1, 1), height / max(rows - 1, 1)


def rest_positions(
        rows: int, cols: int, distances: tuple[float, float], pose: str, z: float) -> np.ndarray:
    """
    Return the flat lattice, its centre above the origin at height ``z`` [m].

    :param pose: horizontal (row 0 at the largest y) or hanging (row 0 on top)
    :return: (rows, cols, 3) float64
    """
    across = (np.arange(cols) - (cols - 1) / 2) * distances[0]
    down = ((rows - 1) / 2 - np.arange(rows)) * distances[1]
    positions = np.zeros((rows, cols, 3))
    positions[..., 0] = across
    positions[..., 2] = z
    positions[..., 2 if pose == 'hanging' else 1] += down[:, None]
    return positions
