# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the cloth can touch: shapes, where they are, and the parameters of each."""

from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import dataclass
from dataclasses import replace
import math
from typing import Any

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.body_names import check_names
from cloth_sim_ros.sim.model.body_names import fields_of_names
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.pose import unit_quaternion
from cloth_sim_ros.sim.model.scene_fields import Field
import numpy as np

NAMES = 'colliders.names'
# Max. colliders [1]: those that are near are bits of a uint in collider_bounds.glsl.
MOST_COLLIDERS = 32
# How many lengths each shape has, and which.
SHAPES = {
    'plane': '', 'sphere': 'radius', 'capsule': 'radius, length between its ends',
    'box': 'side along x, y and z', 'cylinder': 'radius, length'}
# Thickness of a collider over the longer side of a cell [1], below which it can pass between
# nodes: the diagonal of a square of four nodes.
THIN = 1.4
# Max. cosine between the normals of surfaces that press on a node from two sides [1], and the same
# where one of them is thin, as FACING and FACING_THIN in contact.glsl.
FACING, FACING_THIN = -0.9, -0.5
# Step of finite differences of a distance [m].
_STEP = 1e-5
# Edges that a node owns, and points that a face can touch, of each shape [1].
_EDGES_OF_A_NODE = 3
_TIPS = {'plane': 1, 'sphere': 1, 'capsule': 2, 'box': 8, 'cylinder': 4}

# NAME stands for each of colliders.names.
COLLIDER_FIELDS = (
    Field('colliders.NAME.shape', str, 'sphere', 'shape; a plane is its z = 0 and keeps the cloth '
          'above, capsules and cylinders have their axis along z', choices=tuple(SHAPES)),
    Field('colliders.NAME.size', float, (), 'sphere: radius; capsule: radius, length of its axis; '
          'cylinder: radius, length; box: side lengths; plane: none', 'm', low=1e-4, high=1e5,
          is_array=True),
    Field('colliders.NAME.position', float, (0.0, 0.0, 0.0), 'centre, x y z', 'm',
          low=-1e5, high=1e5, is_array=True),
    Field('colliders.NAME.orientation', float, (0.0, 0.0, 0.0, 1.0), 'rotation as a quaternion '
          'x y z w of any length but 0', low=-1e3, high=1e3, is_array=True),
    Field('colliders.NAME.friction', float, 0.3, 'coefficient of Coulomb friction, static and '
          'sliding', low=0.0, high=1e3),
    Field('colliders.NAME.color', float, (), 'red green blue in pictures of cameras; empty for '
          'that of wood, or light grey of a plane', low=0.0, high=1.0, is_array=True),
)


def collider_fields(given: Mapping[str, Any]) -> tuple[Field, ...]:
    """Return the fields of each collider that ``given`` names; names that are wrong have none."""
    return fields_of_names(given.get(NAMES), MOST_COLLIDERS, COLLIDER_FIELDS)


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
    def half_sizes(self) -> tuple[float, float, float]:
        """Return radius and half the length, or half the sides, as shaders take them [m]."""
        if self.shape == 'box':
            x, y, z = self.size
            return x / 2.0, y / 2.0, z / 2.0
        radius, length, _ = (*self.size, 0.0, 0.0, 0.0)[:3]
        return radius, length / 2.0, 0.0

    @property
    def reach(self) -> float:
        """Return how far it is from the centre to the farthest point [m]; 0 for a plane."""
        x, y, z = self.half_sizes
        if self.shape == 'plane':
            return 0.0
        return x + y if self.shape == 'capsule' else math.hypot(x, y, z)

    @property
    def core(self) -> tuple[float, float, float]:
        """
        Return the half axis, in its own axes [m], that all of a long body is near; else 0, 0, 0.

        Twice as long as thick is long.
        """
        if self.shape in ('plane', 'sphere'):
            return 0.0, 0.0, 0.0
        sizes = self.half_sizes
        if self.shape in ('capsule', 'cylinder'):
            sizes = sizes[0], sizes[0], sizes[1]
        longest = sizes.index(max(sizes))
        others = sorted(sizes)[:2]
        x, y, z = (size if axis == longest and size > 2.0 * others[1] else 0.0
                   for axis, size in enumerate(sizes))
        return x, y, z

    @property
    def reach_from_core(self) -> float:
        """Return how far its farthest point is from ``core`` [m]."""
        if not any(self.core):
            return self.reach
        if self.shape == 'box':
            return math.hypot(*sorted(self.half_sizes)[:2])
        return self.half_sizes[0]

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

    def normals(self, points: np.ndarray) -> np.ndarray:
        """Return the directions in which the distance of ``points``, (..., 3) [m], grows."""
        slopes = np.stack([
            self.distance(points + way) - self.distance(points - way)
            for way in _STEP * np.eye(3)], axis=-1)
        return slopes / np.maximum(np.linalg.norm(slopes, axis=-1, keepdims=True), 1e-30)

    @property
    def axes(self) -> np.ndarray:
        """Return its x, y and z axis as the rows of a matrix, (3, 3)."""
        return self.pose.axes


def placed(colliders: Sequence[Collider], poses: Sequence[Pose]) -> tuple[Collider, ...]:
    """Return ``colliders``, each at its pose."""
    return tuple(
        replace(collider, position=pose.position, orientation=pose.orientation)
        for collider, pose in zip(colliders, poses))


def is_thin(collider: Collider, spacing: tuple[float, float]) -> bool:
    """
    Return whether a collider can pass between nodes without touching one.

    :param spacing: of the nodes along a row and along a column [m]
    """
    return collider.thickness < THIN * max(spacing)


def colliders_of(values: Mapping[str, Any]) -> tuple[Collider, ...]:
    """
    Return the colliders that checked scene ``values`` describe, in the order of their names.

    :raises ClothSimError: when a name, size, position or orientation is wrong
    """
    check_names(values[NAMES], NAMES, 'collider', MOST_COLLIDERS)
    return tuple(_collider(values, name) for name in values[NAMES])


def collider_defines(colliders: Sequence[Collider]) -> dict[str, int]:
    """Return what shaders that know ``colliders`` compile in."""
    present = {collider.shape for collider in colliders}
    return {
        'COLLIDERS': len(colliders),
        'HAS_LONG': int(any(any(collider.core) for collider in colliders)),
        **{f'HAS_{shape.upper()}': int(shape in present) for shape in SHAPES}}


def rows_of(collider: Collider) -> int:
    """Return how many contacts a node's edges and faces can have with ``collider``."""
    return _EDGES_OF_A_NODE + 2 * _TIPS[collider.shape]


def surface_defines(colliders: Sequence[Collider], thin: Sequence[int]) -> dict[str, object]:
    """Return what shaders compile in that let the ``thin`` colliders act on edges and faces."""
    return {
        'SURFACE_TIPS': max(_TIPS[colliders[number].shape] for number in thin),
        'SURFACE_COLLIDERS': mask_of(thin),
        'THIN_COLLIDERS': len(thin)}


def mask_of(numbers: Sequence[int]) -> str:
    """Return a bit for each of the colliders of these numbers, as shaders write it."""
    return f'{sum(1 << number for number in numbers)}u'


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
