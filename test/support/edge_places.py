# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where a Snapshot has the tensions of edges that the reference lists one after the other."""

from cloth_sim_ros.reference.edges import Edges
import numpy as np

_KINDS = {(0, 1): 0, (1, 0): 1, (1, 1): 2, (1, -1): 3, (0, 2): 4, (2, 0): 5}


def edge_places(edges: Edges, cols: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return row, column and kind of each edge of a cloth with ``cols`` nodes in a row."""
    row, col = np.divmod(edges.first, cols)
    last_row, last_col = np.divmod(edges.second, cols)
    offsets = zip((last_row - row).tolist(), (last_col - col).tolist())
    return row, col, np.array([_KINDS[offset] for offset in offsets])
