# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where the frames of colliders and grasps are at each time, and how they move."""

from collections.abc import Iterable
from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import dataclass
from dataclasses import replace
import math
from typing import NamedTuple

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.sim.arguments import real_number
from cloth_sim_ros.sim.arguments import word
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.pose import checked_position
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.pose import Quaternion
from cloth_sim_ros.sim.model.pose import rotated
from cloth_sim_ros.sim.model.pose import rotation_between
from cloth_sim_ros.sim.model.pose import unit_quaternion
from cloth_sim_ros.sim.model.pose import Vector
import numpy as np

_SLOWEST, _FASTEST = 1e-6, 1e3
_IN_SECONDS = 'give it in simulated seconds'


@dataclass(frozen=True)
class FrameMove:
    """
    A move to a pose: in a straight line and about one axis, at constant speed, then at rest.

    Translation and rotation both take the time of the slower one.

    :param name: of the collider or grasp
    :param target: of its origin, x y z [m]
    :param orientation: to be reached, unit quaternion x y z w; None to keep the present one
    :param speed: [m/s] in simulated time
    :param angular_speed: [rad/s] in simulated time
    :param start: simulated time at which it begins [s]
    """

    name: str
    target: Vector
    orientation: Quaternion | None
    speed: float
    angular_speed: float
    start: float

    @classmethod
    def checked(
            cls, *, name: str, target: Sequence[float], orientation: Sequence[float] | None,
            speed: float, angular_speed: float, start: float) -> 'FrameMove':
        """Return a FrameMove, or raise ClothSimError saying which value is wrong."""
        named = cut(word(name, 'the name of a frame'))
        speed = real_number(speed, f'the speed of {named}', 'give it in m/s')
        angular_speed = real_number(
            angular_speed, f'the angular_speed of {named}', 'give it in rad/s')
        for quantity, value, unit in (
                ('speed', speed, 'm/s'), ('angular_speed', angular_speed, 'rad/s')):
            if not _SLOWEST <= value <= _FASTEST:
                raise ClothSimError(
                    f'the {quantity} of {named} must be from {_SLOWEST:g} to {_FASTEST:g} {unit}, '
                    f'got {value} {unit}: give it in simulated time')
        return cls(
            name, checked_position(target, f'the target of {named}'),
            None if orientation is None
            else unit_quaternion(orientation, f'the orientation of {named}'),
            speed, angular_speed, float(start))

    def slowed(self, duration: float, origin: Pose) -> 'FrameMove':
        """
        Return it at speeds at which it takes ``duration`` [s], where its own are not lower.

        :param origin: where the frame is when it begins
        """
        duration = real_number(duration, f'the duration of the move of {self.name}', _IN_SECONDS)
        # NaN fails this as well.
        if not 0.0 <= duration < math.inf:
            raise ClothSimError(
                f'the duration of the move of {self.name} must be 0 s or more, got {duration} s: '
                'give 0 for the speeds alone')
        way, _, angle = _way(origin, self)
        return replace(
            self, speed=_slower(self.speed, float(np.linalg.norm(way)), duration),
            angular_speed=_slower(self.angular_speed, angle, duration))


class FramePath:
    """
    One move of a frame, in float64, without accumulated error: it ends exactly at its target.

    ``begin`` and ``arrival`` are simulated times [s].

    :param origin: where the frame is when the move begins
    """

    def __init__(self, move: FrameMove, origin: Pose) -> None:
        """Plan the path from ``origin`` to the target."""
        self.move = move
        self.origin = origin
        self.target = Pose(
            move.target, origin.orientation if move.orientation is None else move.orientation)
        way, self._axis, angle = _way(origin, move)
        duration = max(float(np.linalg.norm(way)) / move.speed, angle / move.angular_speed)
        self.begin = move.start
        self.arrival = move.start + duration
        self._velocity = way / duration if duration > 0.0 else np.zeros(3)
        self._rate = angle / duration if duration > 0.0 else 0.0

    def pose(self, time: float) -> Pose:
        """Return where the frame is at ``time`` [s]."""
        if time >= self.arrival:
            return self.target
        if time <= self.begin:
            return self.origin
        passed = time - self.begin
        x, y, z = (float(part) for part in self.origin.position + self._velocity * passed)
        orientation = self.origin.orientation
        return Pose(
            (x, y, z), rotated(orientation, self._axis, self._rate * passed)
            if self.turns else orientation)

    def is_under_way(self, begin: float, end: float) -> bool:
        """Return whether the frame moves at its constant speed from ``begin`` to ``end`` [s]."""
        return self.begin <= begin and end <= self.arrival

    @property
    def turns(self) -> bool:
        """Return whether the frame changes its orientation."""
        return self._rate > 0.0

    @property
    def velocity(self) -> np.ndarray:
        """Return the velocity of its origin while it moves, (3,) [m/s]."""
        return self._velocity

    @property
    def axis(self) -> Vector:
        """Return the unit axis that it turns about."""
        return self._axis

    @property
    def rate(self) -> float:
        """Return how fast it turns while it moves [rad/s]."""
        return self._rate


class Motions(NamedTuple):
    """
    How n frames move from one time to another.

    :param centres: at the first time [m], (n, 3)
    :param axes: x, y and z axes at that time, (3 n, 3)
    :param velocities: mean velocities of the origins [m/s], (n, 3)
    :param turns: rows of the matrices from a lever arm to the mean velocity of its end [1/s],
        (3 n, 3)
    """

    centres: np.ndarray
    axes: np.ndarray
    velocities: np.ndarray
    turns: np.ndarray

    @property
    def are_rest(self) -> bool:
        """Return whether no frame moves."""
        return not (np.any(self.velocities) or np.any(self.turns))


@dataclass(frozen=True)
class MovedFrame:
    """
    A frame that is elsewhere, or goes elsewhere, than it was to.

    :param name: of the collider
    :param pose: where it is
    :param path: which it is on; None where it is at rest
    """

    name: str
    pose: Pose
    path: FramePath | None


class FramePaths:
    """
    Where some frames are at each time.

    :param origins: their poses at the start of the run, by name
    :param moves: to come, in any order; of one frame, a later one replaces the one before
    """

    def __init__(self, origins: Mapping[str, Pose], moves: Iterable[FrameMove] = ()) -> None:
        """Begin at the start of the run."""
        self._origins = dict(origins)
        self._paths: dict[str, list[FramePath]] = {name: [] for name in origins}
        for move in sorted(moves, key=lambda move: move.start):
            self._append(move)

    def add(self, move: FrameMove) -> FramePath:
        """
        Begin a move at its start, from where its frame is then; earlier frames are dropped.

        :return: its path
        """
        earlier: list[FramePath] = []
        later: list[FramePath] = []
        for path in self._paths[move.name]:
            (earlier if path.begin <= move.start else later).append(path)
        self._origins[move.name] = earlier[-1].origin if earlier else self._origins[move.name]
        self._paths[move.name] = earlier[-1:]
        added = self._append(move)
        for path in later:
            self._append(path.move)
        return added

    def put(self, name: str, pose: Pose) -> None:
        """Have a frame ``name`` at rest, instead of any of that name."""
        self._origins[name] = pose
        self._paths[name] = []

    def drop(self, name: str) -> None:
        """Drop the frame ``name``."""
        del self._origins[name], self._paths[name]

    def under_way(self, now: float) -> tuple[FramePath, ...]:
        """Return the latest path of each frame that moves at ``now`` [s]."""
        found = (self._path(name, now) for name in self._paths)
        return tuple(path for path in found if path is not None and now < path.arrival)

    def differing(self, others: 'FramePaths', now: float) -> tuple[MovedFrame, ...]:
        """Return the frames that are elsewhere, or on another path, than in ``others`` now."""
        found = []
        for name in self._paths:
            path, other = (
                next((each for each in paths.under_way(now) if each.move.name == name), None)
                for paths in (self, others))
            pose = self.pose(name, now)
            if pose != others.pose(name, now) or _way_of(path) != _way_of(other):
                found.append(MovedFrame(name, pose, path))
        return tuple(found)

    def pose(self, name: str, time: float) -> Pose:
        """Return where the frame ``name`` is at ``time`` [s]."""
        path = self._path(name, time)
        return self._origins[name] if path is None else path.pose(time)

    def motions(self, names: Sequence[str], begin: float, end: float) -> Motions:
        """Return how frames move from ``begin`` to ``end`` [s]; not at all if these are equal."""
        count, moves = len(names), end > begin
        firsts = [self.pose(name, begin) for name in names]
        axes = [pose.axes for pose in firsts]
        lasts = [self.pose(name, end) for name in names] if moves else firsts
        velocities, turns = np.zeros((count, 3)), np.zeros((count, 3, 3))
        for i, (name, first, last) in enumerate(zip(names, firsts, lasts)):
            if moves:
                velocities[i] = self._mean_velocity(name, first, last, begin, end)
            if first.orientation != last.orientation:
                # The rotation, less 1, over the time that it takes.
                turns[i] = (last.axes.T @ axes[i] - np.eye(3)) / (end - begin)
        return Motions(
            np.array([pose.position for pose in firsts]), np.concatenate(axes), velocities,
            turns.reshape(3 * count, 3))

    def current(self, name: str, now: float) -> FramePath | None:
        """Return the path that the frame ``name`` moves on at ``now`` [s]; None at rest."""
        path = self._path(name, now)
        return path if path is not None and now < path.arrival else None

    def next_begin(self, name: str, now: float) -> float:
        """Return when the next move of the frame ``name`` begins [s]; infinite for none."""
        return min((path.begin for path in self._paths[name] if path.begin > now),
                   default=math.inf)

    def quiet_until(self, now: float) -> float:
        """Return until when nothing moves: ``now`` itself, or infinite."""
        until = math.inf
        for name, paths in self._paths.items():
            path = self._path(name, now)
            if path is not None and now < path.arrival:
                return now
            until = min((until, *(each.begin for each in paths if each.begin > now)))
        return until

    def _append(self, move: FrameMove) -> FramePath:
        path = FramePath(move, self.pose(move.name, move.start))
        self._paths[move.name].append(path)
        return path

    def _mean_velocity(
            self, name: str, first: Pose, last: Pose, begin: float, end: float) -> np.ndarray:
        """Return that of a frame at these poses at ``begin`` and ``end`` [s], (3,) [m/s]."""
        path = self._path(name, begin)
        # In the middle of a path, the same bits in each step.
        if path is not None and path.is_under_way(begin, end):
            return path.velocity
        return (np.array(last.position) - np.array(first.position)) / (end - begin)

    def _path(self, name: str, time: float) -> FramePath | None:
        return next((path for path in reversed(self._paths[name]) if time >= path.begin), None)


def _way(origin: Pose, move: FrameMove) -> tuple[np.ndarray, Vector, float]:
    """Return the way of ``move`` [m], (3,), and axis and angle [rad] of its rotation."""
    orientation = origin.orientation if move.orientation is None else move.orientation
    axis, angle = rotation_between(origin.orientation, orientation)
    return np.array(move.target) - np.array(origin.position), axis, angle


def _way_of(path: FramePath | None) -> tuple[FrameMove, Pose] | None:
    return None if path is None else (path.move, path.origin)


def _slower(most: float, way: float, duration: float) -> float:
    return min(most, max(way / duration, _SLOWEST)) if duration > 0.0 else most
