# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The wind: steady, as set since, and gusts at their times."""

from collections.abc import Sequence
from dataclasses import dataclass
import math

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.arguments import vector_or_none
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.scene_fields import FASTEST_WIND
import numpy as np


@dataclass(frozen=True)
class Gust:
    """
    Wind on top of the other one for a stretch of simulated time.

    :param start: [s]
    :param duration: [s]
    :param velocity: x y z [m/s]
    """

    start: float
    duration: float
    velocity: tuple[float, float, float]

    @property
    def end(self) -> float:
        """Return the simulated time at which it ends [s]."""
        return self.start + self.duration

    def overlap(self, begin: float, end: float) -> float:
        """Return the share of the time from ``begin`` to ``end`` [s] it blows in, 0 to 1."""
        shared = min(end, self.end) - max(begin, self.start)
        return max(shared, 0.0) / (end - begin)


class Wind:
    """
    The velocity of the air far from the cloth, by simulated time.

    ``steady`` is what blows beside gusts [m/s], x y z.

    :param steady: until another one is set
    :param gusts: on top of it
    """

    def __init__(self, steady: Sequence[float], gusts: Sequence[Gust] = ()) -> None:
        """Blow from the start."""
        self.steady = _three(steady)
        self._gusts = tuple(gusts)

    @property
    def fastest(self) -> float:
        """Return the largest possible speed until another wind is set [m/s]."""
        return math.hypot(*self.steady) + sum(math.hypot(*gust.velocity) for gust in self._gusts)

    def mean(self, begin: float, end: float) -> np.ndarray:
        """Return the mean wind from ``begin`` to ``end`` [s], (3,) [m/s]."""
        wind = np.array(self.steady)
        for gust in self._gusts:
            wind += gust.overlap(begin, end) * np.array(gust.velocity)
        return wind

    def keep(self) -> tuple[float, float, float]:
        """Return what ``restore`` needs to come back to this moment."""
        return self.steady

    def restore(self, kept: tuple[float, float, float]) -> None:
        """Go back to the moment of ``keep``."""
        self.steady = kept


def checked_wind(velocity: Sequence[float]) -> tuple[float, float, float]:
    """Return ``velocity`` [m/s] as three numbers; ClothSimError says what is wrong with it."""
    found = vector_or_none(velocity)
    if found is None or not all(abs(part) <= FASTEST_WIND for part in found):
        raise ClothSimError(
            f'the wind must be 3 numbers of at most {FASTEST_WIND:g} m/s each, got '
            f'{shown(velocity if found is None else list(found))}: give x, y and z')
    return _three(found)


def _three(velocity: Sequence[float]) -> tuple[float, float, float]:
    x, y, z = velocity
    return float(x), float(y), float(z)
