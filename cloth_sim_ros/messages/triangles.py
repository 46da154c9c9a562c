# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The faces of the lattice."""

import numpy as np


def triangles(rows: int, cols: int) -> np.ndarray:
    """
    Return the nodes of the two triangles of each cell, counted along the rows.

    Counter-clockwise seen from above while the cloth lies flat; none for a chain.

    :return: (2 (rows - 1) (cols - 1), 3) uint32
    """
    node = np.arange(rows * cols, dtype='<u4').reshape(rows, cols)
    corners = (
        node[:-1, :-1], node[1:, :-1], node[:-1, 1:],
        node[:-1, 1:], node[1:, :-1], node[1:, 1:])
    return np.stack(corners, axis=-1).reshape(-1, 3)
