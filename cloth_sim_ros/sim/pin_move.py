# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""A pin that goes from where it is to a point."""

from collections.abc import Sequence
from dataclasses import dataclass
import math

from cloth_sim_ros.sim.errors import ClothSimError

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
