# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A force on the cloth for a stretch of simulated time."""

from collections.abc import Sequence
from dataclasses import dataclass
import math

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.arguments import real_number
from cloth_sim_ros.sim.arguments import vector
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np

REGIONS = ('all', 'sphere')
# Max. force [N]: float32 ends at 3e38.
_STRONGEST = 1e30
# Max. coordinate [m] and time [s], those of a scene.
_FARTHEST = 1e6
_LONGEST = 1e9
_IN_SECONDS = 'give it in simulated seconds'
# Distance from a sphere at which a node still counts as on it, over how far from the origin the
# sphere reaches [1]: one unit in the last place of float32; see Push.contains.
_ROUNDING = 2.0**-23
# Rounding of the end of a substep [units in the last place].
_ROUNDED = 8.0


@dataclass(frozen=True)
class Push:
    """
    A total force, distributed by mass over the free nodes of a region.

    :param force: x y z [N], of all nodes together
    :param start: simulated time at which it begins [s]
    :param duration: [s]
    :param region: all or sphere
    :param center: of the sphere [m]
    :param radius: of the sphere [m]
    """

    force: tuple[float, float, float]
    start: float
    duration: float
    region: str = 'all'
    center: tuple[float, float, float] = (0.0, 0.0, 0.0)
    radius: float = 0.0

    @classmethod
    def checked(
            cls, *, force: Sequence[float], start: float, duration: float, region: str = 'all',
            center: Sequence[float] = (0.0, 0.0, 0.0), radius: float = 0.0) -> 'Push':
        """Return a Push, or raise ClothSimError saying which value is wrong."""
        if not isinstance(region, str) or region not in REGIONS:
            raise ClothSimError(
                f'a push needs the region {" or ".join(REGIONS)}, got {shown(region)}: '
                'leave it empty for all')
        vectors = {'force': (force, _STRONGEST, 'N'), 'center': (center, _FARTHEST, 'm')}
        checked = []
        for name, (given, most, unit) in vectors.items():
            x, y, z = vector(given, f'the {name} of a push', unit)
            if max(abs(x), abs(y), abs(z)) > most:
                raise ClothSimError(
                    f'the {name} of a push must be at most {most:g} {unit} along each axis, got '
                    f'{[x, y, z]}: give less')
            checked.append((x, y, z))
        start = real_number(start, 'the start of a push', _IN_SECONDS)
        duration = real_number(duration, 'the duration of a push', _IN_SECONDS)
        radius = real_number(radius, 'the radius of a push', 'give it in metres')
        # Written so that NaN is refused.
        if not 0.0 <= start <= _LONGEST:
            raise ClothSimError(
                f'the start of a push must be from 0 to {_LONGEST:g} s, got {start} s: '
                f'{_IN_SECONDS}')
        if not 0.0 < duration <= _LONGEST:
            raise ClothSimError(
                f'the duration of a push must be above 0 and at most {_LONGEST:g} s, got '
                f'{duration} s: {_IN_SECONDS}')
        if not 0.0 <= radius <= _FARTHEST:
            raise ClothSimError(
                f'the radius of a push must be from 0 to {_FARTHEST:g} m, got {radius} m: give it '
                'in metres')
        if region == 'sphere' and radius == 0.0:
            raise ClothSimError(
                'a push on a sphere needs a radius above 0, got 0 m: '
                'give one, or the region all')
        return cls(checked[0], start, duration, region, checked[1], radius)

    @property
    def end(self) -> float:
        """Return the simulated time at which it ends [s]."""
        return self.start + self.duration

    @property
    def impulse(self) -> tuple[float, float, float]:
        """Return the total impulse [N s]."""
        x, y, z = self.force
        return x * self.duration, y * self.duration, z * self.duration

    def contains(self, positions: np.ndarray) -> np.ndarray:
        """
        Return which of ``positions`` (..., 3) [m] are in the region.

        A sphere holds what is at most its radius r from its center c, within the rounding of
        float32. That moves a position x by up to 2^-24 abs(x), where abs(x) <= abs(c) + r on the
        surface. The center and the radius, which may have been float32 too, are off by up to
        2^-24 abs(c) and 2^-24 r. Together that is 2^-23 (abs(c) + r): the tolerance.
        """
        if self.region == 'all':
            return np.ones(positions.shape[:-1], dtype=bool)
        # As the device holds them, also those of a float64 reference: both find the same nodes.
        held = np.asarray(positions, dtype=np.float32).astype(float)
        reach = math.hypot(*self.center) + self.radius
        return np.linalg.norm(held - self.center, axis=-1) <= self.radius + _ROUNDING * reach

    def overlap(self, begin: float, end: float) -> float:
        """
        Return the fraction of the step ``begin`` to ``end`` [s] in which it acts, 0 to 1.

        The end of the last substep can be later than that of its step by rounding: what begins
        with the next step has no part in it.
        """
        shared = min(end, self.end) - max(begin, self.start)
        goes_on = self.start < begin or end < self.end
        if shared <= 0.0 or (goes_on and shared <= _ROUNDED * math.ulp(end)):
            return 0.0
        return shared / (end - begin)
