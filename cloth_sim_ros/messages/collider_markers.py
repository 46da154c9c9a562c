# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Colliders as markers: what viewers show of the bodies that the cloth touches."""

from collections.abc import Sequence
from typing import Any

from cloth_sim_ros.sim.colliders import Collider
import numpy as np
from visualization_msgs.msg import Marker

COLOR = (0.55, 0.58, 0.62, 1.0)
# How far a plane is shown, in lengths of the cloth, and how thick [m].
_PLANE_SIDE, _PLANE_THICKNESS = 6.0, 1e-3


def collider_markers(colliders: Sequence[Collider], cloth_size: float) -> list[dict[str, Any]]:
    """
    Return the markers of ``colliders`` as put_marker takes them.

    :param cloth_size: length of the longer side of the cloth [m], which planes are shown by
    """
    return [
        {'namespace': f'collider/{collider.name}', 'number': number, 'color': COLOR, **part}
        for collider in colliders
        for number, part in enumerate(_parts(collider, cloth_size))]


def _parts(collider: Collider, cloth_size: float) -> list[dict[str, Any]]:
    position = np.array(collider.position)
    at = {'position': collider.position, 'orientation': collider.orientation}
    if collider.shape == 'plane':
        side = _PLANE_SIDE * cloth_size
        below = position - 0.5 * _PLANE_THICKNESS * collider.axes[2]
        return [{**at, 'position': _point(below), 'kind': Marker.CUBE,
                 'scale': (side, side, _PLANE_THICKNESS)}]
    if collider.shape == 'box':
        return [{**at, 'kind': Marker.CUBE, 'scale': collider.size}]
    width = 2.0 * collider.size[0]
    ball = {**at, 'kind': Marker.SPHERE, 'scale': (width, width, width)}
    if collider.shape == 'sphere':
        return [ball]
    length = collider.size[1]
    middle = {**at, 'kind': Marker.CYLINDER, 'scale': (width, width, length)}
    if collider.shape == 'cylinder':
        return [middle]
    ends = [
        {**ball, 'position': _point(position + side * 0.5 * length * collider.axes[2])}
        for side in (-1.0, 1.0)]
    return [middle, *ends]


def _point(position: np.ndarray) -> tuple[float, float, float]:
    x, y, z = (float(part) for part in position)
    return x, y, z
