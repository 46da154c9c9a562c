# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where a moving pin is at each time, and where it ends."""

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
import math
from typing import Protocol

from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np

# Farther out float32 holds no cloth any more.
FARTHEST = 1e6
_SLOWEST, _FASTEST = 1e-6, 1e6


@dataclass(frozen=True)
class PinMove:
    """
    A straight path at constant speed, at the end of which the pin rests.

    :param row: of the pinned node
    :param col: of the pinned node
    :param target: x y z [m]
    :param speed: [m/s] in simulated time
    :param start: simulated time at which it begins [s]
    """

    row: int
    col: int
    target: tuple[float, float, float]
    speed: float
    start: float

    @classmethod
    def checked(
            cls, *, row: int, col: int, target: Sequence[float], speed: float,
            start: float) -> 'PinMove':
        """Return a PinMove, or raise ClothSimError saying which value is wrong."""
        if len(target) != 3 or not all(math.isfinite(part) for part in target):
            raise ClothSimError(
                'the target of a pin must be 3 finite numbers [m], '
                f'got {[float(part) for part in target]}: give x, y and z')
        if max(map(abs, target)) > FARTHEST:
            raise ClothSimError(
                f'the target of a pin must be at most {FARTHEST:g} m along each axis, got '
                f'{[float(part) for part in target]}: keep the cloth near the origin')
        if not _SLOWEST <= speed <= _FASTEST:
            raise ClothSimError(
                f'the speed of a pin must be from {_SLOWEST:g} to {_FASTEST:g} m/s, got {speed} '
                'm/s: give it in simulated time')
        x, y, z = map(float, target)
        return cls(row, col, (x, y, z), float(speed), float(start))

    @property
    def node(self) -> tuple[int, int]:
        """Return row and col."""
        return self.row, self.col


class Way(Protocol):
    """What a pin follows; ``begin`` and ``arrival`` are simulated times [s]."""

    begin: float
    arrival: float

    def position(self, time: float) -> np.ndarray:
        """Return where the pin is at ``time`` [s], (3,) [m]."""

    def velocity(self, begin: float, end: float, at_begin: np.ndarray) -> np.ndarray:
        """Return what takes the pin from ``at_begin`` at ``begin`` to its place at ``end``."""


class PinPath:
    """
    The path of one pin, in float64, without accumulated error: it ends exactly at its target.

    ``begin`` and ``arrival`` are simulated times [s].

    :param move: the move to make
    :param origin: where the pin is when it begins [m], (3,)
    """

    def __init__(self, move: PinMove, origin: np.ndarray) -> None:
        """Plan the path from ``origin`` to the target."""
        self.move = move
        self._origin = np.asarray(origin, dtype=float)
        self._target = np.array(move.target)
        way = self._target - self._origin
        length = float(np.linalg.norm(way))
        self.begin = move.start
        self.arrival = move.start + length / move.speed
        self._velocity = way * (move.speed / length) if length > 0.0 else np.zeros(3)

    def put_off(self, now: float, until: float) -> 'PinPath':
        """Return the rest of the way, on which the pin stands still from ``now`` ``until`` [s]."""
        later = copy(self)
        later._origin = self.position(now)
        later.begin = until
        later.arrival += until - now
        return later

    def position(self, time: float) -> np.ndarray:
        """Return where the pin is at ``time`` [s], (3,) [m]."""
        if time >= self.arrival:
            return self._target
        return self._origin + self._velocity * max(time - self.begin, 0.0)

    def velocity(self, begin: float, end: float, at_begin: np.ndarray) -> np.ndarray:
        """
        Return what takes the pin from where it is at ``begin`` to where it is at ``end`` [m/s].

        :param at_begin: where it is at ``begin`` [m]; on another way, if this one begins later
        """
        # On the way the velocity has the same bits in each step: only then has nothing changed.
        if self.begin <= begin and end <= self.arrival:
            return self._velocity
        return (self.position(end) - at_begin) / (end - begin)
