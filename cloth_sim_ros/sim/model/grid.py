# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The nodes of the lattice: where they lie at rest, and which is nearest to a point."""

from collections.abc import Sequence
from dataclasses import dataclass
import math

from cloth_sim_ros.sim.arguments import real_number
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NotFoundError
from cloth_sim_ros.sim.model.pose import checked_position
import numpy as np

# Default max. distance of a node from a point that stands for it [m]: as clicked_point.radius.
USUAL_REACH = 0.1


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
    point = checked_position(point, 'a point')
    max_distance = real_number(max_distance, parameter, 'give the distance in metres')
    if not max_distance > 0.0:
        raise ClothSimError(
            f'{parameter} must be above 0, got {max_distance:g}: give the distance in metres, '
            'or leave it out')
    away = positions - np.array(point, dtype=np.float32)
    squares = np.einsum('rci,rci->rc', away, away)
    # There is no node where positions are NaN.
    squares = np.where(np.isnan(squares), np.inf, squares)
    if pinned is not None:
        if not pinned.any():
            raise NotFoundError('the cloth has no pin that is near to the point: pin a node first')
        squares = np.where(pinned, squares, np.inf)
    row, col = np.unravel_index(int(np.argmin(squares)), squares.shape)
    found = NearNode(int(row), int(col), math.dist(positions[row, col], point))
    if found.distance > max_distance:
        x, y, z = point
        raise NotFoundError(
            f'no {"node" if pinned is None else "pin"} is within {max_distance:g} m of the point '
            f'({x:g}, {y:g}, {z:g}): the nearest, ({row}, {col}), is {found.distance:.3g} m away; '
            f'give a point nearer to it, or a larger {parameter}')
    return found


def usual_reach(rows: int, cols: int, distances: tuple[float, float]) -> float:
    """Return how far a node may be from a point that means it [m]: further on a coarse cloth."""
    dx, dy = distances
    return max(USUAL_REACH, dx if cols > 1 else 0.0, dy if rows > 1 else 0.0)
