# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The adaptive scheme `constraint`: Gauss-Seidel impulses hold edges at the limit."""

import math

from cloth_sim_ros.reference.coloured import coloured_edges
from cloth_sim_ros.reference.energy_tank import EnergyTankReference
from cloth_sim_ros.reference.limited_cloth import LimitedCloth
from cloth_sim_ros.reference.substeps import geometric_substep
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# Of the geometric bound, at this limit; it goes with this power of the limit.
_GEOMETRIC, _USUAL_LIMIT, _POWER = 0.15, 0.1, 0.5
_GROWTH = 1.1
_SHORTEST = 1e-3
_COMPLIANCE = 0.03
# The least share of what is beyond the limit that a substep takes back.
_LEAST_CORRECTION = 0.2
_USUAL_SHARE = 0.02
# A tension moves an edge by at most this part of its length within a substep.
_MOST_MOVED = 0.5
# Of the way to the limit, by which what is applied alone may stretch an edge in a substep.
_FALL = 0.25
_MORE_SWEEPS = 2
# A cloth that is farther beyond its limit than this, of the limit, is brought to it with this
# time constant [s].
_FAR, _SLACK_TIME, _NO_SLACK = 0.5, 0.3, 1e-3


class ImpulseAdaptiveReference(LimitedCloth):
    """
    Explicit springs, and an impulse along each edge that would pass its limit.

    The impulse is the multiplier of a one-sided constraint at the limit: it may pull an edge
    at its upper limit and push one at its lower, and it goes when the edge leaves the limit.
    Multipliers are kept as the start of the next substep, as tensions [N].

    :param scene: what is modelled; its timed pushes act at their times
    :param limit: the strain at which edges are held, if not the scene's
    :param sweeps: through all colours in a substep, if not the scene's
    """

    def __init__(
            self, scene: Scene, limit: float | None = None, sweeps: int | None = None) -> None:
        """Start at rest in the scene's start pose."""
        super().__init__(scene, limit)
        self.sweeps: int = scene['adaptive.sweeps'] if sweeps is None else sweeps
        self.groups = [
            group[self.limited[group]] for group in coloured_edges(scene, self.edges)]
        self.tension = np.zeros(len(self.edges))
        self._share = _GEOMETRIC * (self.limit / _USUAL_LIMIT)**_POWER
        # How far an edge may stretch [m].
        self._reach = self.limit * min(scene.spacing)
        self._length = self._usual = self.spring_substep
        self._tank = EnergyTankReference(self._reach)
        # What is added to the limit: at first, and for how long already, in time constants.
        self._slack = self._slack_age = 0.0
        self._is_new = True
        # The limit of the last substep.
        self._limit_before = self.limit
        # Of the edges at the start of the substep.
        self._differences = self._directions = np.zeros((len(self.edges), 3))
        self._lengths = np.zeros(len(self.edges))

    @property
    def is_idle(self) -> bool:
        """Tell whether no edge was held in the last substep."""
        return not self.tension.any()

    @property
    def limit_now(self) -> float:
        """Return the limit, with what is added for a cloth that was far beyond it."""
        return self.limit + self._slack * (1.0 + self._slack_age) * math.exp(-self._slack_age)

    def _see(self, strain: float) -> None:
        if self._is_new and strain > (1.0 + _FAR) * self.limit:
            self._slack = strain - self.limit
        self._is_new = False

    def _held(self) -> np.ndarray:
        return self.tension != 0.0

    def _next_length(self, acceleration: float) -> float:
        if self.fixed:
            return self.spring_substep
        # A node may be pulled and pushed; an edge that is held while the limit is wider is longer.
        pulling = np.where(
            self.tension > 0.0, (1.0 + self.limit) / (1.0 + self._limit_before), 1.0)
        allowed = self._share * geometric_substep(
            self.edges, np.abs(self.tension) * pulling, self.inverse_masses)
        allowed = min(allowed, _GROWTH * self._length, self.spring_substep)
        if acceleration > 0.0:
            allowed = min(allowed, math.sqrt(2.0 * _FALL * self._reach / acceleration))
        self._length = max(allowed, _SHORTEST * self.spring_substep)
        return self._length

    def _limited_substep(self, begin: float, end: float) -> None:
        h = end - begin
        velocities = self._spring_velocities(begin, end).reshape(-1, 3)
        self._differences = self.edges.differences(self._flat_positions)
        self._directions = self.edges.directions(self._flat_positions)
        self._lengths = self.edges.lengths(self._flat_positions)
        velocities -= self._kick * self.inverse_masses[:, None] * self.edges.scatter(
            self.tension[:, None] * self._directions, len(velocities))
        wanted = max(
            _LEAST_CORRECTION * min(1.0, h / self._usual), h / self.spring_substep)
        correction = self._tank.share(wanted, h)
        self._usual += _USUAL_SHARE * (h - self._usual)
        longest_next = _GROWTH * max(self._length, h)
        for _ in range(self.sweeps * (_MORE_SWEEPS if self._tank.is_overdrawn else 1)):
            for group in self.groups:
                self._sweep(group, velocities, h, correction, longest_next)
        self._book(velocities, begin, end)
        self._slack_age += h / _SLACK_TIME
        if self.limit_now - self.limit < _NO_SLACK * self.limit:
            self._slack = 0.0
        self.velocities = velocities.reshape(self.positions.shape)
        self.positions = self.positions + h * self.velocities

    def _book(self, velocities: np.ndarray, begin: float, end: float) -> None:
        """Take down the work of the tensions of a substep that ends with ``velocities``."""
        h = end - begin
        self._limit_before = self.limit_now
        if self.is_idle:
            self._tank = EnergyTankReference(self._reach)
            return
        rates = self.edges.differences(self.velocities.reshape(-1, 3) + velocities)
        opening = 0.5 * np.sum(rates * self._directions, axis=1)
        lengths = np.linalg.norm(
            self._differences + h * self.edges.differences(velocities), axis=1)
        stretch = lengths - self.edges.rest_length
        reach = self.limit_now * self.edges.rest_length
        beyond = stretch - np.clip(stretch, -reach, reach)
        free = self.inverse_masses > 0.0
        kinetic = 0.5 * np.sum(velocities[free]**2 / self.inverse_masses[free, None])
        self._tank.book(
            self._kick * float(self.tension @ opening),
            float(np.sum(np.maximum(self.tension * beyond, 0.0))), float(kinetic),
            self._load(begin, end), h)

    def _load(self, begin: float, end: float) -> float:
        """Return the magnitudes of what is applied, summed over nodes and pushes [N]."""
        # A push keeps its impulse, whatever forces act for.
        scale = (end - begin) / self._kick
        everywhere, regions = self._applied_everywhere(begin, end)
        pushed = scale * (everywhere - self.gravity) + self.gravity
        return self.scene.node_mass * (
            self.scene.node_count * float(np.linalg.norm(pushed))
            + scale * sum(most * count for most, count in regions))

    def _sweep(
            self, group: np.ndarray, velocities: np.ndarray, h: float, correction: float,
            longest_next: float) -> None:
        """
        Bring the edges of one group, which share no node, to the limit or let them go.

        The length is the foreseen one. The impulse acts along the edge as it is now: along the
        foreseen edge it would turn the cloth.
        """
        first, second = self.edges.first[group], self.edges.second[group]
        ahead = np.linalg.norm(
            self._differences[group] + h * (velocities[first] - velocities[second]), axis=1)
        rest = self.edges.rest_length[group]
        stretch = self._lengths[group] - rest
        reach = self.limit_now * rest
        # What is beyond the limit already comes back bit by bit.
        beyond = (1.0 - correction) * (stretch - np.clip(stretch, -reach, reach))
        most = rest + reach + np.maximum(beyond, 0.0)
        least = rest - reach + np.minimum(beyond, 0.0)
        per_length = 1.0 / (h * self._kick * self.weight_sums[group])
        old = self.tension[group]
        pull = np.maximum((old + (ahead - most) * per_length) / (1.0 + _COMPLIANCE), 0.0)
        press = np.minimum((old + (ahead - least) * per_length) / (1.0 + _COMPLIANCE), 0.0)
        most_moved = _MOST_MOVED * np.maximum(rest, self._lengths[group]) / (
            longest_next**2 * self.weight_sums[group])
        new = np.clip(
            (old >= 0.0) * pull + (old <= 0.0) * press, -most_moved, most_moved)
        change = (self._kick * (new - old))[:, None] * self._directions[group]
        velocities[first] -= self.inverse_masses[first, None] * change
        velocities[second] += self.inverse_masses[second, None] * change
        self.tension[group] = new
