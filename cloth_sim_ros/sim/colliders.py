# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the cloth can touch: shapes, and where they are."""

from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import dataclass
import math
from typing import Any

from cloth_sim_ros.sim.collider_fields import check_names
from cloth_sim_ros.sim.collider_fields import NAMES
from cloth_sim_ros.sim.collider_fields import SHAPES
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.pose import Pose
from cloth_sim_ros.sim.pose import unit_quaternion
import numpy as np


@dataclass(frozen=True)
class Collider:
    """
    A rigid body that the cloth touches and does not move.

    :param name: of its own in the scene
    :param shape: one of SHAPES
    :param size: lengths of the shape [m], () for a plane
    :param position: of its centre [m]
    :param orientation: unit quaternion x y z w
    :param friction: coefficient of Coulomb friction
    """

    name: str
    shape: str
    size: tuple[float, ...]
    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float]
    friction: float

    @property
    def thickness(self) -> float:
        """Return how far a way through it is at least [m]; infinite for a plane."""
        if self.shape == 'plane':
            return math.inf
        if self.shape == 'box':
            return min(self.size)
        if self.shape == 'cylinder':
            return min(2.0 * self.size[0], self.size[1])
        return 2.0 * self.size[0]

    @property
    def pose(self) -> Pose:
        """Return where it is."""
        return Pose(self.position, self.orientation)

    def distance(self, points: np.ndarray) -> np.ndarray:
        """
        Return how far ``points``, (..., 3) [m], are from its surface [m], (...); negative inside.

        Outside, and in bodies without edges, it is exact; inside others that of the nearest side.
        """
        p = self.pose.seen_from(points)
        if self.shape == 'plane':
            return p[..., 2]
        half = self.size[-1] / 2.0
        if self.shape == 'box':
            return _from_sides(np.abs(p) - np.array(self.size) / 2.0)
        if self.shape == 'cylinder':
            across = np.hypot(p[..., 0], p[..., 1])
            return _from_sides(
                np.stack([across - self.size[0], np.abs(p[..., 2]) - half], axis=-1))
        if self.shape == 'capsule':
            p[..., 2] -= np.clip(p[..., 2], -half, half)
        return np.linalg.norm(p, axis=-1) - self.size[0]

    @property
    def axes(self) -> np.ndarray:
        """Return its x, y and z axis as the rows of a matrix, (3, 3)."""
        return self.pose.axes


def colliders_of(values: Mapping[str, Any]) -> tuple[Collider, ...]:
    """
    Return the colliders that checked scene ``values`` describe, in the order of their names.

    :raises ClothSimError: when a name, size, position or orientation is wrong
    """
    check_names(values[NAMES])
    return tuple(_collider(values, name) for name in values[NAMES])


def collider_defines(colliders: Sequence[Collider]) -> dict[str, int]:
    """Return what shaders that know ``colliders`` compile in."""
    present = {collider.shape for collider in colliders}
    return {
        'COLLIDERS': len(colliders),
        **{f'HAS_{shape.upper()}': int(shape in present) for shape in SHAPES}}


def _from_sides(q: np.ndarray) -> np.ndarray:
    """Return the distance of what is ``q`` before each of some sides, (..., sides)."""
    return np.linalg.norm(np.maximum(q, 0.0), axis=-1) + np.minimum(q.max(axis=-1), 0.0)


def _collider(values: Mapping[str, Any], name: str) -> Collider:
    group = f'colliders.{name}'
    shape, size = values[f'{group}.shape'], values[f'{group}.size']
    lengths = SHAPES[shape]
    wanted = {'': 0, 'radius': 1, 'side along x, y and z': 3}.get(lengths, 2)
    if len(size) != wanted:
        raise ClothSimError(
            f'{group}.size needs {wanted} for a {shape}, got {len(size)}: give '
            f'[{lengths}]' if wanted else
            f'{group}.size is given, and a plane has none: leave it out')
    px, py, pz = _numbers(values, f'{group}.position', 3, '[x, y, z]')
    return Collider(
        name, shape, tuple(size), (px, py, pz),
        unit_quaternion(values[f'{group}.orientation'], f'{group}.orientation'),
        values[f'{group}.friction'])


def _numbers(values: Mapping[str, Any], name: str, count: int, form: str) -> tuple[float, ...]:
    if len(values[name]) != count:
        raise ClothSimError(f'{name} needs {count} numbers, got {len(values[name])}: write {form}')
    return values[name]
