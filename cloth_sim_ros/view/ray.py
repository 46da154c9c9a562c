# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where a ray meets the cloth."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Hit:
    """
    A point of the cloth, and the node that is nearest to it.

    :param point: x y z [m]
    :param node: its number, counted along the rows
    """

    point: tuple[float, float, float]
    node: int


def first_hit(
        origin: Sequence[float], direction: Sequence[float], points: np.ndarray,
        faces: np.ndarray) -> Hit | None:
    """
    Return where the ray first meets a triangle, from either side; None where it meets none.

    T. Moeller, B. Trumbore, Fast, minimum storage ray/triangle intersection, Journal of Graphics
    Tools 2(1), 1997.

    :param origin: (3,) [m]
    :param direction: (3,), of any length
    :param points: (nodes, 3) [m]
    :param faces: (triangles, 3) numbers of nodes
    """
    start, along = np.asarray(origin, float), np.asarray(direction, float)
    corners = points[faces].astype(float)
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    across = np.cross(along, second)
    determinant = np.einsum('ti,ti->t', first, across)
    away = start - corners[:, 0]
    turned = np.cross(away, first)
    with np.errstate(divide='ignore', invalid='ignore'):
        u = np.einsum('ti,ti->t', away, across) / determinant
        v = np.einsum('i,ti->t', along, turned) / determinant
        distance = np.einsum('ti,ti->t', second, turned) / determinant
        meets = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (distance > 0.0)
    if not meets.any():
        return None
    triangle = int(np.argmin(np.where(meets, distance, np.inf)))
    point = start + distance[triangle] * along
    nearest = np.argmin(np.linalg.norm(corners[triangle] - point, axis=-1))
    return Hit(tuple(point.tolist()), int(faces[triangle, nearest]))
