# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Position and orientation of a body, and the rotation from one orientation to another."""

from collections.abc import Sequence
from dataclasses import dataclass
import math
from typing import Any

from cloth_sim_ros.sim.arguments import vector
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np

# Max. coordinate [m]: float32 rounds it by 8 mm, and farther out holds no cloth.
FARTHEST = 1e5
# Least length of a quaternion that is a rotation [1].
_LEAST_QUATERNION = 1e-6
# Difference from 1 of the length of a quaternion that is kept as it is [1], some roundings of
# float64: made a unit again, it would have other bits.
_ROUNDING = 1e-15

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
NO_ROTATION: Quaternion = (0.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Pose:
    """
    Where a body is.

    :param position: x y z [m]
    :param orientation: unit quaternion x y z w
    """

    position: Vector
    orientation: Quaternion = NO_ROTATION

    @property
    def axes(self) -> np.ndarray:
        """Return its x, y and z axis as the rows of a matrix, (3, 3)."""
        return np.array(_axes(*self.orientation))

    @property
    def inverse(self) -> 'Pose':
        """Return the pose of the world, seen from here."""
        x, y, z, w = self.orientation
        back = (-x, -y, -z, w)
        px, py, pz = turned(self.position, back)
        return Pose((-px, -py, -pz), back)

    def placed(self, inner: 'Pose') -> 'Pose':
        """Return ``inner``, a pose in the frame of this one, in the world."""
        x, y, z = turned(inner.position, self.orientation)
        px, py, pz = self.position
        orientation = product(self.orientation, inner.orientation)
        return Pose(
            (px + x, py + y, pz + z), unit_quaternion(orientation, 'an orientation'))

    def seen_from(self, points: np.ndarray) -> np.ndarray:
        """Return ``points`` of the world, (n, 3) [m], in the frame of this pose."""
        return (points - np.array(self.position)) @ self.axes.T

    def in_world(self, points: np.ndarray) -> np.ndarray:
        """Return ``points`` of the frame of this pose, (n, 3) [m], in the world."""
        return np.array(self.position) + points @ self.axes


def checked_position(position: Sequence[float], of: str) -> Vector:
    """Return ``position``, or raise ClothSimError; ``of`` is its name in the error."""
    x, y, z = vector(position, of)
    if max(abs(x), abs(y), abs(z)) > FARTHEST:
        raise ClothSimError(
            f'{of} must be at most {FARTHEST:g} m along each axis, got {[x, y, z]}: keep the '
            'cloth near the origin')
    return x, y, z


def unit_quaternion(orientation: Sequence[float], of: str) -> Quaternion:
    """Return ``orientation`` x y z w of length 1, or raise ClothSimError; ``of`` names it."""
    parts = vector(
        orientation, of, '', length=4, verb='needs', hint='write [x, y, z, w]')
    length = math.hypot(*parts)
    if not _LEAST_QUATERNION < length < math.inf:
        raise ClothSimError(
            f'{of} {list(parts)} has no direction: give a quaternion x y z w, '
            '[0.0, 0.0, 0.0, 1.0] for none')
    divisor = length if abs(length - 1.0) > _ROUNDING else 1.0
    x, y, z, w = (part / divisor for part in parts)
    return x, y, z, w


def quaternion_of(axes: np.ndarray) -> Quaternion:
    """
    Return the orientation x y z w of a frame, by the largest of the four (Shepperd 1978).

    :param axes: its x, y and z axis in the world, the rows of a rotation, (3, 3)
    """
    a = np.asarray(axes, float)
    trace = float(np.trace(a))
    # Four times the squares of x, y, z, w.
    squares = np.array([*(1.0 + 2.0 * np.diag(a) - trace), 1.0 + trace])
    k = int(np.argmax(squares))
    differences = (a[1, 2] - a[2, 1], a[2, 0] - a[0, 2], a[0, 1] - a[1, 0])
    parts = np.empty(4)
    if k == 3:
        parts[:] = (*differences, squares[3])
    else:
        parts[:3] = a[k] + a[:, k]
        parts[k] = squares[k]
        parts[3] = differences[k]
    return unit_quaternion(parts.tolist(), 'an orientation')


def rotation_between(first: Quaternion, second: Quaternion) -> tuple[Vector, float]:
    """Return unit axis and angle [rad], 0 to pi, of what turns ``first`` into ``second``."""
    x, y, z, w = product(second, (-first[0], -first[1], -first[2], first[3]))
    sine = math.hypot(x, y, z)
    if sine == 0.0:
        return (0.0, 0.0, 1.0), 0.0
    # The shorter way round.
    sign = math.copysign(1.0 / sine, w)
    return (x * sign, y * sign, z * sign), 2.0 * math.atan2(sine, abs(w))


def rotated(orientation: Quaternion, axis: Vector, angle: float) -> Quaternion:
    """Return ``orientation`` turned by ``angle`` [rad] about the unit ``axis`` of the world."""
    sine = math.sin(0.5 * angle)
    x, y, z = axis
    found = product((x * sine, y * sine, z * sine, math.cos(0.5 * angle)), orientation)
    length = math.hypot(*found)
    return found[0] / length, found[1] / length, found[2] / length, found[3] / length


def rotated_each(
        orientations: np.ndarray, axes: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """
    Return what ``rotated`` does of each, to the bit, (n, 4).

    :param orientations: unit quaternions x y z w, (n, 4)
    :param axes: unit axes of the world, (n, 3)
    :param angles: [rad], (n,)
    """
    # Sines of numpy may have other last bits.
    halves = (0.5 * angles).tolist()
    sines = np.array([math.sin(half) for half in halves])
    x, y, z = (axes * sines[:, None]).T
    found = np.stack(_product(
        (x, y, z, np.array([math.cos(half) for half in halves])), orientations.T), axis=-1)
    return found / np.array([math.hypot(*each) for each in found.tolist()])[:, None]


def axes_of_each(orientations: np.ndarray) -> np.ndarray:
    """Return the axes of a Pose with each of ``orientations`` (n, 4), to the bit, (n, 3, 3)."""
    return np.ascontiguousarray(np.moveaxis(np.array(_axes(*orientations.T)), -1, 0))


def between(first: Pose, second: Pose, share: float) -> Pose:
    """Return the pose after a ``share``, 0 to 1, of the way from ``first`` to ``second``."""
    ax, ay, az = first.position
    bx, by, bz = second.position
    axis, angle = rotation_between(first.orientation, second.orientation)
    return Pose(
        (ax + share * (bx - ax), ay + share * (by - ay), az + share * (bz - az)),
        rotated(first.orientation, axis, share * angle))


def turned(vector: Vector, orientation: Quaternion) -> Vector:
    """Return ``vector`` of a frame with the unit ``orientation``, in the world."""
    x, y, z = vector
    qx, qy, qz, qw = orientation
    found = product(product(orientation, (x, y, z, 0.0)), (-qx, -qy, -qz, qw))
    return found[:3]


def product(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the quaternion that turns by ``b`` and then by ``a``."""
    return _product(a, b)


# For single numbers and for arrays of them, with the same bits.

def _product(a: Any, b: Any) -> Any:
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def _axes(x: Any, y: Any, z: Any, w: Any) -> Any:
    return (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)),
        (2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)),
        (2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)))
