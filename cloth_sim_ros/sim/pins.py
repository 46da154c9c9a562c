# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which nodes a list of pin names holds."""

from collections.abc import Sequence
import re

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np

_REGIONS = {
    'none': None,
    'all': np.s_[:, :],
    'top_left': np.s_[0, 0],
    'top_right': np.s_[0, -1],
    'bottom_left': np.s_[-1, 0],
    'bottom_right': np.s_[-1, -1],
    'top_edge': np.s_[0, :],
    'bottom_edge': np.s_[-1, :],
}
# What a pin can be called.
PIN_NAMES = f'{", ".join(_REGIONS)}, or a node as "row,col"'


def pinned_nodes(
        names: Sequence[str], rows: int, cols: int, parameter: str = 'pins') -> np.ndarray:
    """
    Return which nodes ``names`` hold, (rows, cols) bool.

    :param names: corners, edges, all, none, or 'row,col'
    :param parameter: where the names stand, for the error
    :raises ClothSimError: for a name that is none of these or a node outside the cloth
    """
    pinned = np.zeros((rows, cols), dtype=bool)
    for name in names:
        node = re.fullmatch(r'\s*(\d{1,9})\s*,\s*(\d{1,9})\s*', name)
        if node:
            row, col = int(node[1]), int(node[2])
            check_node(row, col, rows, cols)
            pinned[row, col] = True
        elif name not in _REGIONS:
            raise ClothSimError(
                f'{parameter} has {shown(name)}: give {PIN_NAMES}')
        elif name != 'none':
            pinned[_REGIONS[name]] = True
    return pinned


def only_node(name: str, rows: int, cols: int, parameter: str) -> tuple[int, int]:
    """Return row and col of the node ``name``; ClothSimError when it is none or several."""
    nodes = np.argwhere(pinned_nodes([name], rows, cols, parameter)).tolist()
    if len(nodes) != 1:
        raise ClothSimError(
            f'{parameter} has {shown(name)}, which is {len(nodes)} nodes: '
            'give a corner, or a node as "row,col"')
    row, col = nodes[0]
    return row, col


def check_node(row: int, col: int, rows: int, cols: int) -> None:
    """Raise ClothSimError when the cloth has no node (row, col)."""
    if not (0 <= row < rows and 0 <= col < cols):
        raise ClothSimError(
            f'there is no node ({row}, {col}) in a cloth of {rows} x {cols} nodes: '
            f'give a row from 0 to {rows - 1} and a col from 0 to {cols - 1}')
