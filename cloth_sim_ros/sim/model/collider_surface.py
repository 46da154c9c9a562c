# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The surface of a collider as a lattice of points, to draw it as a cloth is drawn."""

from collections.abc import Callable
from functools import lru_cache

from cloth_sim_ros.sim.model.colliders import Collider
import numpy as np

_AROUND = 96   # points of a circle: a chord is off by 0.05 % of the radius
_OVER = 48     # from pole to pole
_LEVEL = 1e-9

# Points and unit normals, (rows, cols, 3) each.
Lattice = tuple[np.ndarray, np.ndarray]


def collider_surface(
        collider: Collider, around: np.ndarray = np.zeros(3), reach: float = 1.0) -> Lattice:
    """
    Return points of the surface where it is [m], and the normals there, which point outwards.

    Rows run downwards and columns counter-clockwise, seen from outside, as those of a cloth.

    :param around: of a plane, the square next to this point is returned [m], (3,)
    :param reach: half the side of that square [m]
    """
    points, normals = local_surface(collider.shape, collider.size, reach)
    pose = collider.pose
    if collider.shape == 'plane':
        points = points + pose.seen_from(np.array(around, float)) * (1.0, 1.0, 0.0)
    return pose.in_world(points), normals @ pose.axes


@lru_cache(maxsize=64)
def local_surface(shape: str, size: tuple[float, ...], reach: float = 1.0) -> Lattice:
    """
    Return what ``collider_surface`` does, in the frame of the collider.

    :param size: lengths of the shape [m]
    :param reach: of a plane, half the side of the square around the origin [m]
    """
    lattice = _SHAPES[shape]((reach,) if shape == 'plane' else size)
    for part in lattice:
        part.flags.writeable = False
    return lattice


def ground(colliders: tuple[Collider, ...]) -> float | None:
    """Return the height of the uppermost level plane that carries cloth [m]; None without one."""
    heights = [
        collider.position[2] for collider in colliders
        if is_ground(collider)]
    return max(heights, default=None)


def is_ground(collider: Collider) -> bool:
    """Return whether it is a plane that is level and carries cloth."""
    return collider.shape == 'plane' and float(collider.axes[2, 2]) > 1.0 - _LEVEL


def _plane(size: tuple[float, ...]) -> Lattice:
    half, = size
    corners = half * np.array([
        [(-1.0, 1.0, 0.0), (1.0, 1.0, 0.0)], [(-1.0, -1.0, 0.0), (1.0, -1.0, 0.0)]])
    return corners, np.broadcast_to((0.0, 0.0, 1.0), corners.shape).copy()


def _sphere(size: tuple[float, ...]) -> Lattice:
    radius, = size
    return _turned(radius, 0.0, _OVER)


def _capsule(size: tuple[float, ...]) -> Lattice:
    radius, length = size
    return _turned(radius, length / 2.0, _OVER)


def _turned(radius: float, half: float, over: int) -> Lattice:
    """Return the surface around all points within ``half`` of the origin on the z axis."""
    angles = np.linspace(0.0, np.pi, over + 1)
    # The equator twice: once at either end.
    angles = np.insert(angles, over // 2, np.pi / 2.0)
    ends = np.where(np.arange(len(angles)) <= over // 2, half, -half)
    circle = _circle()
    normals = np.concatenate([
        np.sin(angles)[:, None, None] * circle,
        np.broadcast_to(np.cos(angles)[:, None, None], (len(angles), len(circle), 1))], axis=-1)
    points = radius * normals
    points[..., 2] += ends[:, None]
    return points, normals


def _cylinder(size: tuple[float, ...]) -> Lattice:
    radius, length = size
    circle = _circle()
    return _prism(radius * circle, circle, length / 2.0)


def _box(size: tuple[float, ...]) -> Lattice:
    half = np.array(size) / 2.0
    # Each side from corner to corner, so that corners have the normal of either side.
    corners = np.array([(1, -1), (1, 1), (1, 1), (-1, 1), (-1, 1), (-1, -1), (-1, -1), (1, -1)])
    outward = np.repeat(np.array([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]), 2, axis=0)
    return _prism(half[:2] * corners, outward, float(half[2]))


def _prism(outline: np.ndarray, outward: np.ndarray, half: float) -> Lattice:
    """Return the surface over ``outline``, (n, 2), up to ``half`` above and below it."""
    # Share of the outline, height, share of the outward normal, upward part of the normal.
    rows = ((0, half, 0, 1), (1, half, 0, 1), (1, half, 1, 0), (1, -half, 1, 0),
            (1, -half, 0, -1), (0, -half, 0, -1))
    points, normals = (
        np.stack([np.concatenate([share * flat, np.full((len(flat), 1), float(up))], axis=-1)
                  for share, up in parts])
        for flat, parts in (
            (outline, [row[:2] for row in rows]), (outward, [row[2:] for row in rows])))
    return points, normals


def _circle() -> np.ndarray:
    angles = np.linspace(0.0, 2.0 * np.pi, _AROUND + 1)
    return np.stack([np.cos(angles), np.sin(angles)], axis=-1)


_SHAPES: dict[str, Callable[[tuple[float, ...]], Lattice]] = {
    'plane': _plane, 'sphere': _sphere, 'capsule': _capsule, 'box': _box, 'cylinder': _cylinder}
