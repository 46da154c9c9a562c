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

"""The adaptive scheme `impulse`: Gauss-Seidel impulses hold edges at the limit."""

import math

from cloth_sim_ros.reference.coloured import coloured_edges
from cloth_sim_ros.reference.limited_cloth import LimitedCloth
from cloth_sim_ros.reference.limited_cloth import split_evenly
from cloth_sim_ros.reference.substeps import geometric_substep
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.stability import safe_substep
import numpy as np

# Of the geometric bound; at 0.25 the energy spikes.
_GEOMETRIC = 0.2
_GROWTH = 1.1
_SHORTEST = 5e-5
# A warm start moves an edge by at most this part of its rest length within a substep.
_WARM_REACH = 0.5


class ImpulseAdaptiveReference(LimitedCloth):
    """
    Explicit springs, and an impulse along each edge that would pass its limit.

    The impulse is the multiplier of a one-sided constraint at the limit: it may pull an edge
    at its upper limit and push one at its lower, and it goes when the edge leaves the limit.
    Impulses are kept as the start of the next substep.

    :param scene: what is modelled; its timed pushes act at their times
    :param limit: the strain at which edges are held
    :param sweeps: through all colours in a substep
    """

    def __init__(self, scene: Scene, limit: float = 0.1, sweeps: int = 4) -> None:
        """Start at rest in the scene's start pose."""
        super().__init__(scene, limit)
        self.sweeps = sweeps
        self.colours = [
            colour[self.limited[colour]] for colour in coloured_edges(scene, self.edges)]
        self.base_substep = safe_substep(scene)
        # Of the last substep: the impulse of each edge [N s], and its length [s].
        self.impulse = np.zeros(len(self.edges))
        self._last_substep = 0.0
        self._substep_now = self.base_substep
        # Of the edges at the start of the substep.
        self._differences = self._directions = np.zeros((len(self.edges), 3))

    def _step_of_dt(self) -> None:
        end = (self.steps + 1) * self.dt
        now = self.time
        count = 0
        while end - now > 1e-9 * self.dt:
            self._substep_now = max(
                min(self.base_substep, self._geometric_substep(),
                    self._substep_now * _GROWTH), _SHORTEST)
            h = split_evenly(end - now, self._substep_now)
            self._substep(now, now + h)
            now += h
            count += 1
        self.substeps = count
        self._note_active(self.impulse != 0.0)

    def _geometric_substep(self) -> float:
        if self._last_substep == 0.0:
            return math.inf
        tension = np.abs(self.impulse) / self._last_substep
        return _GEOMETRIC * geometric_substep(self.edges, tension, self.inverse_masses)

    def _substep(self, begin: float, end: float) -> None:
        h = end - begin
        velocities = self._spring_velocities(begin, end).reshape(-1, 3)
        self._differences = self.edges.differences(self._flat_positions)
        self._directions = self.edges.directions(self._flat_positions)
        if self._last_substep > 0.0:
            self._warm_start(velocities, h)
        for _ in range(self.sweeps):
            for colour in self.colours:
                self._sweep(colour, velocities, h)
        self._last_substep = h
        self.velocities = velocities.reshape(self.positions.shape)
        self.positions = self.positions + h * self.velocities

    def _warm_start(self, velocities: np.ndarray, h: float) -> None:
        """Apply the impulses of the last substep again, along the edges as they are now."""
        held = self.impulse != 0.0
        most = np.full(len(self.edges), 0.0)
        most[held] = _WARM_REACH * self.edges.rest_length[held] / (h * self.weight_sums[held])
        self.impulse = np.clip(self.impulse * (h / self._last_substep), -most, most)
        velocities -= self.inverse_masses[:, None] * self.edges.scatter(
            self.impulse[:, None] * self._directions, len(velocities))

    def _sweep(self, colour: np.ndarray, velocities: np.ndarray, h: float) -> None:
        """
        Bring the edges of one colour, which share no node, to the limit or let them go.

        The length is the foreseen one. The impulse acts along the edge as it is now: along the
        foreseen edge it would turn the cloth.
        """
        first, second = self.edges.first[colour], self.edges.second[colour]
        foreseen = self._differences[colour] + h * (velocities[first] - velocities[second])
        length = np.linalg.norm(foreseen, axis=1)
        rest = self.edges.rest_length[colour]
        upper, lower = rest * (1.0 + self.limit), rest * (1.0 - self.limit)
        old = self.impulse[colour]
        at_upper = (old > 0.0) | ((old == 0.0) & (length > upper))
        at_lower = (old < 0.0) | ((old == 0.0) & (length < lower))
        per_length = 1.0 / (h * self.weight_sums[colour])
        new = np.where(
            at_upper, np.maximum(old + (length - upper) * per_length, 0.0),
            np.where(at_lower, np.minimum(old + (length - lower) * per_length, 0.0), 0.0))
        self.impulse[colour] = new
        change = (new - old)[:, None] * self._directions[colour]
        velocities[first] -= self.inverse_masses[first, None] * change
        velocities[second] += self.inverse_masses[second, None] * change
