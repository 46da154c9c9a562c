# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The node of a lattice that is nearest to a point."""

from collections.abc import Sequence
from dataclasses import dataclass
import math

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.pose import checked_position
import numpy as np


@dataclass(frozen=True)
class NearNode:
    """
    A node and its distance from the point of the query.

    :param distance: [m]
    """

    row: int
    col: int
    distance: float


def near_node(
        positions: np.ndarray, point: Sequence[float], max_distance: float,
        pinned: np.ndarray | None = None, *, parameter: str = 'max_distance') -> NearNode:
    """
    Return the node nearest to ``point`` [m].

    :param positions: (rows, cols, 3) [m]
    :param max_distance: how far the node may be from the point [m]; infinite for any node
    :param pinned: (rows, cols) bool, to look among these nodes alone
    :param parameter: what ``max_distance`` is set by, for the error
    :raises ClothSimError: when the point is none, no node is pinned, or the node is too far away
    """
    checked_position(point, 'a point')
    if not max_distance > 0.0:
        raise ClothSimError(
            f'{parameter} must be above 0, got {max_distance:g}: give the distance in metres, '
            'or leave it out')
    away = positions - np.array(point, dtype=np.float32)
    squares = np.einsum('rci,rci->rc', away, away)
    if pinned is not None:
        if not pinned.any():
            raise ClothSimError('the cloth has no pin that is near to the point: pin a node first')
        squares = np.where(pinned, squares, np.inf)
    row, col = np.unravel_index(int(np.argmin(squares)), squares.shape)
    found = NearNode(int(row), int(col), math.dist(positions[row, col], point))
    if found.distance > max_distance:
        x, y, z = point
        raise ClothSimError(
            f'no {"node" if pinned is None else "pin"} is within {max_distance:g} m of the point '
            f'({x:g}, {y:g}, {z:g}): the nearest, ({row}, {col}), is {found.distance:.3g} m away; '
            f'give a point nearer to it, or a larger {parameter}')
    return found
