# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Normals of a cloth from its positions alone."""

import numpy as np


def surface_normals(positions: np.ndarray) -> np.ndarray:
    """
    Return unit normals, up for a cloth that lies flat with row 0 at the largest y.

    From central differences, one-sided ones at the border; (0, 0, 1) where the cloth has no area.

    :param positions: (rows, cols, 3) [m]
    :return: (rows, cols, 3) float64
    """
    along, down = (_difference(positions, axis) for axis in (1, 0))
    normals = np.cross(down, along)
    length = np.linalg.norm(normals, axis=-1, keepdims=True)
    return np.where(length > 0.0, normals / np.where(length > 0.0, length, 1.0), (0.0, 0.0, 1.0))


def _difference(positions: np.ndarray, axis: int) -> np.ndarray:
    if positions.shape[axis] < 2:
        return np.zeros_like(positions)
    return np.gradient(positions, axis=axis)
