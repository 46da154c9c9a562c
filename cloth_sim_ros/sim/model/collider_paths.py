# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where the colliders of a scene are, and those of many cloths, each by its own clock."""

from collections.abc import Sequence
from enum import Enum
import math
from typing import NamedTuple

from cloth_sim_ros.sim.model.frame_paths import FrameMove
from cloth_sim_ros.sim.model.frame_paths import FramePath
from cloth_sim_ros.sim.model.frame_paths import FramePaths
from cloth_sim_ros.sim.model.pose import axes_of_each
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.pose import rotated_each
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# Fraction of a substep that counts as rounding [1]: that of mode mass_spring.
_ROUNDING = 1e-6
_BODY = np.dtype([
    ('moves', bool), ('turns', bool), ('begin', float), ('origin', float, 3),
    ('velocity', float, 3), ('orientation', float, 4), ('axis', float, 3), ('rate', float)])


def paths_of_scene(scene: Scene) -> FramePaths:
    """Return where the colliders of a scene are, by its timed moves."""
    return FramePaths(
        {collider.name: collider.pose for collider in scene.colliders},
        scene.timed_collider_moves())


class Change(Enum):
    """What differs between the motions in two substeps."""

    NOTHING = 0
    CENTRES = 1
    ALL = 2


class _Going(NamedTuple):
    """
    The bodies that move, of cloths in which none begins, ends or changes its move.

    :param cloths: of each body, (m,)
    :param bodies: places in their cloths, (m,)
    :param begins: when their moves began by the clocks of their cloths [s], (m,)
    :param origins: where, (m, 3) [m]
    :param velocities: (m, 3) [m/s]
    :param turning: places here of those that turn, (k,)
    :param turns: their moves, (k,) of _BODY
    """

    cloths: np.ndarray
    bodies: np.ndarray
    begins: np.ndarray
    origins: np.ndarray
    velocities: np.ndarray
    turning: np.ndarray
    turns: np.ndarray

    @classmethod
    def of(cls, bodies: np.ndarray, are_going: np.ndarray) -> '_Going':
        """Return those of ``bodies`` (cloths, n) whose cloths ``are_going`` (cloths,)."""
        cloths, places = np.nonzero(are_going[:, None] & bodies['moves'])
        moving = bodies[cloths, places]
        turning = np.flatnonzero(moving['turns'])
        return cls(
            cloths, places, moving['begin'], moving['origin'], moving['velocity'], turning,
            moving[turning])


class StackedPaths:
    """
    How the bodies of many cloths move in each substep, to the bit as in a run of each cloth alone.

    Of a cloth of which no body begins, ends or changes its move in a substep, the motions are
    found for all such cloths together; of others, one by one. ``centres`` [m], (cloths, n, 3),
    ``axes`` (cloths, n, 3, 3), ``velocities`` [m/s], (cloths, n, 3), and ``turns`` [1/s],
    (cloths, n, 3, 3), are those of frame_paths.Motions.

    :param scenes: of each cloth, with bodies of the same names
    :param firsts: number of the first step of each cloth, (cloths,) int
    :param length: of a substep [s]
    :param most: max. substeps that a run of one cloth makes at once
    """

    def __init__(
            self, scenes: Sequence[Scene], firsts: np.ndarray, *, length: float,
            most: int) -> None:
        """Put the bodies where the scenes have them."""
        self._scenes = tuple(scenes)
        self._names = [collider.name for collider in scenes[0].colliders]
        self._dt: float = scenes[0]['dt']
        self._length = length
        self._most = most
        count, bodies = len(scenes), len(self._names)
        self._firsts = np.array(firsts)
        self._paths = [paths_of_scene(scene) for scene in scenes]
        self.centres = np.zeros((count, bodies, 3))
        self.axes = np.zeros((count, bodies, 3, 3))
        self.velocities = np.zeros((count, bodies, 3))
        self.turns = np.zeros((count, bodies, 3, 3))
        # Times of each cloth [s] from and until which its bodies stay where they are.
        self._rests_from = np.full(count, math.inf)
        self._rests_until = np.full(count, -math.inf)
        # Times [s] between which each body continues its move, or rests.
        self._goes_from = np.full(count, math.inf)
        self._goes_until = np.full(count, -math.inf)
        self._quiet_until = np.zeros(count)
        self._moving = np.zeros((count, bodies), dtype=_BODY)
        # When the present step begins by the clock of each cloth, and the substeps of it made.
        self._begins = np.zeros(count)
        self._made = 0
        # Substeps that a run of each cloth alone would make at once from here.
        self._left = np.zeros(count, dtype=int)
        # The bodies that are found together, and before which substep of the step they alone are.
        self._going = _Going.of(self._moving, np.zeros(count, dtype=bool))
        self._goes_on_until = 0

    @property
    def alike(self) -> int:
        """Return in how many substeps from the present one on all bodies move as in it."""
        return int(self._left.min())

    def begin(self, cloth: int, number: int) -> None:
        """Put the bodies of a cloth back to the start of its scene; step ``number`` is next."""
        self._firsts[cloth] = number
        self._paths[cloth] = paths_of_scene(self._scenes[cloth])
        self._forget(cloth)

    def move(self, cloth: int, move: FrameMove) -> FramePath:
        """Start the motion of a body of a cloth; return its path."""
        self._forget(cloth)
        return self._paths[cloth].add(move)

    def poses(self, cloth: int, time: float) -> list[Pose]:
        """Return where the bodies of a cloth are at its ``time`` [s]."""
        return [self._paths[cloth].pose(name, time) for name in self._names]

    def begin_step(self, number: int) -> None:
        """Begin the step of that ``number``."""
        self._begins = (number - self._firsts) * self._dt
        self._made = self._goes_on_until = 0
        self._left[:] = 0

    def find(self, made: int, quiet: float) -> Change:
        """
        Find the motions in a substep; return what differs from those found before.

        :param made: substeps of the present step before it
        :param quiet: how long all other loads stay as they are from it on [s]
        """
        self._left -= made - self._made
        self._made = made
        if made < self._goes_on_until:
            return self._go_on(made)
        is_due = self._left <= 0
        if not is_due.any():
            return Change.NOTHING
        begins = self._begins + made * self._length
        ends = begins + self._length
        is_new = is_due & ~((self._rests_from <= begins) & (ends <= self._rests_until))
        goes_on = is_new & (self._goes_from < begins) & (ends < self._goes_until)
        ones = np.flatnonzero(is_new & ~goes_on).tolist()
        for cloth in ones:
            self._find_one(cloth, float(begins[cloth]), float(ends[cloth]))
        # As mode mass_spring counts them.
        together = np.minimum(self._quiet_until - begins, quiet) / self._length + _ROUNDING
        self._left[is_due] = np.maximum(1, np.minimum(self._most, together[is_due]).astype(int))
        if not goes_on.any():
            return Change.ALL if ones else Change.NOTHING
        self._going = _Going.of(self._moving, goes_on)
        # Until another cloth has to be looked at; one substep less than rounding could add.
        rounds = (self._goes_until - begins)[goes_on].min() / self._length - 1.0
        others = self._left[~goes_on].min(initial=self._most)
        self._goes_on_until = made + int(min(rounds, others))
        changed = self._go_on(made)
        return Change.ALL if ones else changed

    def _find_one(self, cloth: int, begin: float, end: float) -> None:
        paths = self._paths[cloth]
        motions = paths.motions(self._names, begin, end)
        self.centres[cloth], self.velocities[cloth] = motions.centres, motions.velocities
        self.axes[cloth] = motions.axes.reshape(-1, 3, 3)
        self.turns[cloth] = motions.turns.reshape(-1, 3, 3)
        quiet = self._quiet_until[cloth] = paths.quiet_until(begin)
        self._rests_from[cloth], self._rests_until[cloth] = (
            (begin, max(end, quiet)) if motions.are_rest else (math.inf, -math.inf))
        self._moving['moves'][cloth] = False
        moving: list[FramePath] = []
        for body, name in enumerate(self._names):
            path = paths.current(name, begin)
            if path is not None:
                moving.append(path)
                self._moving[cloth, body] = (
                    True, path.turns, path.begin, path.origin.position, path.velocity,
                    path.origin.orientation, path.axis, path.rate)
        self._goes_from[cloth] = max((path.begin for path in moving), default=math.inf)
        self._goes_until[cloth] = min((
            *(path.arrival for path in moving),
            *(paths.next_begin(name, begin) for name in self._names)))

    def _go_on(self, made: int) -> Change:
        """Move the bodies of ``_going`` on to a substep."""
        going, shift = self._going, made * self._length
        begins = self._begins[going.cloths] + shift
        passed = begins - going.begins
        self.centres[going.cloths, going.bodies] = (
            going.origins + going.velocities * passed[:, None])
        # A cloth that goes on is looked at anew in each substep.
        self._left[going.cloths] = 1
        if not len(going.turning):
            return Change.CENTRES
        turning, moving = going.turning, going.turns
        begins, passed = begins[turning], passed[turning]
        ends = begins + self._length
        count = len(turning)
        found = rotated_each(
            np.tile(moving['orientation'], (2, 1)), np.tile(moving['axis'], (2, 1)),
            np.concatenate([moving['rate'] * passed, moving['rate'] * (ends - moving['begin'])]))
        first, last = found[:count], found[count:]
        axes = axes_of_each(found)
        places = going.cloths[turning], going.bodies[turning]
        self.axes[places] = axes[:count]
        turns = np.swapaxes(axes[count:], 1, 2) @ axes[:count] - np.eye(3)
        turns /= (ends - begins)[:, None, None]
        turns[np.all(first == last, axis=-1)] = 0.0
        self.turns[places] = turns
        return Change.ALL

    def _forget(self, cloth: int) -> None:
        self._left[cloth] = self._goes_on_until = 0
        self._rests_from[cloth] = self._goes_from[cloth] = math.inf
        self._rests_until[cloth] = self._goes_until[cloth] = -math.inf
