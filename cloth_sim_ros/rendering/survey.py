# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The extent of the cloths and pushes of a picture."""

from collections.abc import Iterable
from collections.abc import Sequence

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.rendering.look import StrainRange
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.collider_surface import collider_surface
from cloth_sim_ros.sim.model.collider_surface import is_ground
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.snapshot import FLAG_AT_LIMIT
import numpy as np

_DIRECTIONS = 256
_SIDE = 64        # nodes looked at along each side of a frame, its last ones among them
_POINTS = 97
# [m]: the outline of a larger sphere is nowhere near the cloth, and leaves float32.
_MOST = 1e12
_ARROW = 0.3          # of the largest push, over the longest side of all cloths
_WITH_WORDS = 1.2     # room for an arrow and its words, over its length
_BELOW = 0.03         # from the lowest point to the floor, over the longest side
_BESIDE = 0.6         # farther from all cloths, colliders may be cut off; over the longest side


class Extent:
    """Keeps, of all points given, those that reach farthest in some direction."""

    def __init__(self) -> None:
        """Begin with no point."""
        self._directions = _even_directions(_DIRECTIONS)
        self._reach = np.full(len(self._directions), -np.inf)
        self._farthest = np.zeros((len(self._directions), 3))

    @property
    def points(self) -> np.ndarray:
        """Get the points that were kept [m], (n, 3); none before the first was given."""
        return self._farthest[np.isfinite(self._reach)]

    @property
    def low(self) -> np.ndarray:
        """Get the lowest x, y and z of all points [m]."""
        return self.points.min(axis=0)

    @property
    def high(self) -> np.ndarray:
        """Get the highest x, y and z of all points [m]."""
        return self.points.max(axis=0)

    @property
    def size(self) -> float:
        """Get the longest of the sides along x, y and z [m]."""
        return float(np.max(self.high - self.low))

    def add(self, points: np.ndarray) -> None:
        """Add ``points``, (..., 3) [m]; those that are not finite are ignored."""
        flat = points.reshape(-1, 3)
        flat = flat[np.isfinite(flat).all(axis=1)]
        if not len(flat):
            return
        reach = flat @ self._directions.T
        best = reach.argmax(axis=0)
        farther = reach.max(axis=0) > self._reach
        self._reach[farther] = reach.max(axis=0)[farther]
        self._farthest[farther] = flat[best[farther]]

    def add_nodes(self, positions: np.ndarray) -> None:
        """Add a cloth, (rows, cols, 3) [m]; of a fine one, an even selection of nodes."""
        rows, cols = (_chosen(count) for count in positions.shape[:2])
        self.add(positions[np.ix_(rows, cols)])


class Box:
    """The box around all points given, along x, y and z."""

    def __init__(self) -> None:
        """Begin with no point."""
        self._low = np.full(3, np.inf)
        self._high = np.full(3, -np.inf)

    @property
    def corners(self) -> np.ndarray:
        """Get its corners [m], (8, 3); none before the first point was given."""
        if not np.isfinite(self._low).all():
            return np.zeros((0, 3))
        return np.stack(
            np.meshgrid(*np.stack([self._low, self._high], axis=1)), axis=-1).reshape(-1, 3)

    def add(self, points: np.ndarray) -> None:
        """Add ``points``, (n, 3) [m]; those that are not finite are ignored."""
        finite = points[np.isfinite(points).all(axis=1)]
        if len(finite):
            self._low = np.minimum(self._low, finite.min(axis=0))
            self._high = np.maximum(self._high, finite.max(axis=0))


def _chosen(count: int) -> np.ndarray:
    return np.unique(np.linspace(0, count - 1, min(count, _SIDE)).round().astype(int))


def _even_directions(count: int) -> np.ndarray:
    """Return unit vectors on a spiral over the sphere, and the axes first."""
    number = np.arange(count) + 0.5
    height = 1.0 - 2.0 * number / count
    turn = np.pi * (1.0 + np.sqrt(5.0)) * number
    ring = np.sqrt(1.0 - height**2)
    spiral = np.stack([ring * np.cos(turn), ring * np.sin(turn), height], axis=1)
    return np.concatenate([np.eye(3), -np.eye(3), spiral])


def region_rings(pushes: Iterable[Push], axes: np.ndarray) -> list[np.ndarray]:
    """
    Return a circle for each of ``pushes`` that acts on a sphere whose outline can be in view.

    :param axes: of the camera that looks at it: right, up and towards it
    :return: (n, 3) each [m], the last point again the first
    """
    angles = np.linspace(0.0, 2.0 * np.pi, _POINTS)
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1) @ axes[:2]
    return [
        np.array(push.center) + push.radius * circle for push in pushes
        if push.region != 'all' and push.radius < _MOST]


class Survey:
    """
    Looks at all frames that will be shown, one after the other.

    ``pins``, ``grasps`` and ``limits`` are the boxes around the nodes that are pinned, grasped and
    at their strain limit; with ``shows_pushes`` and ``shows_colliders`` they say what a legend
    has to explain.
    """

    def __init__(self) -> None:
        """Begin with no frame."""
        self.strains = StrainRange()
        self.pins = Box()
        self.grasps = Box()
        self.limits = Box()
        self.shows_colliders = False
        self.frames = 0
        self._cloth = Extent()
        self._largest_force = 0.0
        self._arrows: list[np.ndarray] = []
        self._regions: set[tuple[float, float, float, float]] = set()
        self._bodies = Extent()
        self._last_bodies: tuple[Collider, ...] = ()

    @property
    def shows_pushes(self) -> bool:
        """Return whether a push acts in some frame."""
        return bool(self._arrows)

    @property
    def arrow_length(self) -> float:
        """Get the length of the largest push's arrow [m]."""
        return _ARROW * self._cloth.size

    @property
    def floor(self) -> float:
        """Get the height of the floor of frames without a level plane [m]."""
        low = min([self._cloth.low[2], *self._near_bodies[:, 2]])
        return float(low) - _BELOW * self._cloth.size

    @property
    def size(self) -> float:
        """Get the longest side along x, y and z of all cloths [m]."""
        return self._cloth.size

    @property
    def middle(self) -> np.ndarray:
        """Get the middle of all cloths [m]."""
        return (self._cloth.low + self._cloth.high) / 2.0

    @property
    def points(self) -> np.ndarray:
        """Get points around all in view [m], (n, 3); ClothSimError without a finite one."""
        cloth = self._cloth.points
        if not len(cloth):
            raise ClothSimError(
                'no node to render has a finite position: choose times before the run became '
                'non-finite, with --at')
        room = _WITH_WORDS * self.arrow_length / self._largest_force if self._arrows else 0.0
        tips = [tail + room * force for tail, force in self._arrows]
        # A region larger than the cloth is not worth a small picture.
        rims = [
            np.array(center) + radius * np.concatenate([np.eye(3), -np.eye(3)])
            for *center, radius in self._regions if radius < self._cloth.size / 2.0]
        return np.concatenate(
            [cloth, *np.reshape(tips, (-1, 1, 3)), *rims, self._near_bodies])

    @property
    def _near_bodies(self) -> np.ndarray:
        """Get what colliders but planes reach to next to the cloths [m], (n, 3)."""
        points, room = self._bodies.points, _BESIDE * self._cloth.size
        inside = (points > self._cloth.low - room) & (points < self._cloth.high + room)
        return points[inside.all(axis=1)]

    def add(self, frame: Frame) -> None:
        """Look at ``frame``."""
        self.frames += 1
        positions = frame.positions
        self._cloth.add_nodes(positions)
        self.strains.add(frame.strain)
        self.pins.add(positions[frame.pinned & ~frame.grasped])
        self.grasps.add(positions[frame.grasped])
        self.limits.add(positions[(frame.records['flags'] & FLAG_AT_LIMIT) != 0])
        self._add_colliders(frame.colliders)
        pushes = frame.acting_pushes
        largest = largest_force(pushes)
        self._largest_force = max(self._largest_force, largest)
        self._regions.update(
            (*push.center, push.radius) for push in pushes if push.region != 'all')
        for tail, tip in frame.push_arrows(1.0):
            self._arrows.append(np.stack([tail, largest * (tip - tail)]))

    def _add_colliders(self, colliders: tuple[Collider, ...]) -> None:
        # A level plane is drawn as the floor.
        self.shows_colliders = self.shows_colliders or not all(map(is_ground, colliders))
        for collider in colliders:
            if collider.shape != 'plane' and collider not in self._last_bodies:
                self._bodies.add(collider_surface(collider)[0])
        self._last_bodies = colliders

    def arrows(self, frame: Frame) -> list[np.ndarray]:
        """Return tail and tip [m] of each push in ``frame``, as long as the force is large."""
        share = largest_force(frame.acting_pushes) / max(self._largest_force, 1e-30)
        return frame.push_arrows(self.arrow_length * share)


def largest_force(pushes: Sequence[Push]) -> float:
    """Return the largest force [N] of ``pushes``; 0 without one."""
    return max((float(np.linalg.norm(push.force)) for push in pushes), default=0.0)
