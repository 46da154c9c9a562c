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

"""What the adaptive schemes share: explicit springs, and edges that may not pass a limit."""

from abc import abstractmethod
import math

from cloth_sim_ros.reference.calm_watch import CalmWatch
from cloth_sim_ros.reference.cloth import ReferenceCloth
from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.reference.push_force import push_acceleration
from cloth_sim_ros.reference.push_force import push_weight
from cloth_sim_ros.reference.springs import total_forces
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.stability import choose_substeps
import numpy as np

# Bend springs may bend as far as they like: it is not a strain of the cloth.
LIMITED = ('structural', 'shear')


class LimitedCloth(ReferenceCloth):
    """
    Springs with a limit on the strain of the structural and shear ones.

    A step has mass-spring substeps while no edge comes near its limit, and those of the scheme
    while some do, as mode adaptive has.

    :param scene: what is modelled; its timed pushes act at their times
    :param limit: the strain beyond which an edge is held, if not the scene's
    """

    def __init__(self, scene: Scene, limit: float | None = None) -> None:
        """Start at rest in the scene's start pose."""
        super().__init__(scene)
        self.limit: float = scene['adaptive.threshold'] if limit is None else limit
        self.edges = edges_of(scene)
        weights = self.inverse_masses
        self.weight_sums = weights[self.edges.first] + weights[self.edges.second]
        self.limited = self.edges.of(LIMITED) & (self.weight_sums > 0.0)
        self.fixed = not scene['auto_substeps']
        self.spring_substep = self.dt / (
            scene['substeps'] if self.fixed else choose_substeps(scene))
        self._watch = CalmWatch(self.limit, self._foresee)
        # Of the last dt: which edges were held at its end, the share of the limited ones that
        # changed since the end of the dt before, and the substeps.
        self.active = np.zeros(len(self.edges), bool)
        self.switched = 0.0
        self.substeps = 0
        # Of the last substep, 0 before the first, and for how long forces act in this one [s].
        self._before = self._kick = 0.0

    def max_strain(self) -> float:
        """Return the largest |l / L0 - 1| of the limited edges."""
        return self._max_strain_at(self._flat_positions)

    @property
    @abstractmethod
    def is_idle(self) -> bool:
        """Tell whether nothing is held, so that a mass-spring substep does the same."""

    def _see(self, strain: float) -> None:
        """Take the largest strain at the last look of the watch."""

    @abstractmethod
    def _next_length(self, acceleration: float) -> float:
        """
        Return the longest limited substep that may come next [s].

        :param acceleration: that no node exceeds by what is applied [m/s2]
        """

    @abstractmethod
    def _limited_substep(self, begin: float, end: float) -> None:
        """Step the state on by a substep of the scheme."""

    @abstractmethod
    def _held(self) -> np.ndarray:
        """Return which edges are held now, bool."""

    @property
    def _flat_positions(self) -> np.ndarray:
        return self.positions.reshape(-1, 3)

    def _step_of_dt(self) -> None:
        begin, done, count = self.steps * self.dt, 0.0, 0
        while self.dt - done > 1e-9 * self.dt:
            left, now = self.dt - done, begin + done
            if self._is_calm(now, left):
                h = split_evenly(left, self.spring_substep)
                self._kick = self._kick_of(h)
                self.velocities = self._spring_velocities(now, now + h)
                self.positions = self.positions + h * self.velocities
                self._watch.spend(1)
            else:
                ahead = min(left, self._before or left)
                h = split_evenly(left, self._next_length(self._greatest(now, now + ahead)))
                self._kick = self._kick_of(h)
                self._limited_substep(now, now + h)
            self._before = h
            done += h
            count += 1
        self.substeps = count
        self._note_active(self._held())

    def _applied_everywhere(
            self, begin: float, end: float) -> tuple[np.ndarray, list[tuple[float, int]]]:
        """
        Return what accelerates every node, and what comes on top in regions.

        :return: [m/s2], and of each push on a region its acceleration [m/s2] and its nodes
        """
        everywhere, regions = self.gravity.astype(float), []
        # Settles the nodes of what begins.
        self._push_accelerations(begin, end)
        for push, nodes in self._acting:
            weight, count = push_weight(push, begin, end), int(np.count_nonzero(nodes))
            if weight == 0.0 or not count:
                continue
            acceleration = weight * push_acceleration(push, nodes, self.scene.node_mass)[nodes][0]
            if push.region == 'all':
                everywhere = everywhere + acceleration
            else:
                regions.append((float(np.linalg.norm(acceleration)), count))
        return everywhere, regions

    def _greatest(self, begin: float, end: float) -> float:
        """Return an acceleration by what is applied that no node exceeds [m/s2]."""
        everywhere, regions = self._applied_everywhere(begin, end)
        return float(np.linalg.norm(everywhere)) + sum(most for most, _ in regions)

    def _kick_of(self, h: float) -> float:
        # A velocity belongs to the middle of its substep.
        return 0.5 * ((self._before or h) + h)

    def _is_calm(self, now: float, left: float) -> bool:
        length = split_evenly(left, self.spring_substep)
        if not self.is_idle:
            return False
        calm = self._watch.calm_substeps(now, length, self._quiet_until(now)) > 0
        self._see(self._watch.seen)
        return calm

    def _quiet_until(self, now: float) -> float:
        pushes = self._waiting + [push for push, _ in self._acting]
        starts = (push.start for push in pushes if push.start + push.duration > now)
        return max(min(starts, default=math.inf), now)

    def _foresee(
            self, now: float, ahead: float, length: float,
            kick: float | None = None) -> tuple[float, float]:
        acceleration = self.gravity * self.free[..., None] + length / (
            kick or length) * self._push_accelerations(now, now + length)
        then = self.positions + ahead * (self.velocities + ahead * acceleration)
        return self.max_strain(), self._max_strain_at(then.reshape(-1, 3))

    def _max_strain_at(self, positions: np.ndarray) -> float:
        strains = np.abs(self.edges.strains(positions))
        return float(np.max(strains[self.limited], initial=0.0))

    def _note_active(self, active: np.ndarray) -> None:
        changed = np.count_nonzero(active != self.active)
        self.switched = changed / max(np.count_nonzero(self.limited), 1)
        self.active = active

    def _spring_velocities(self, begin: float, end: float) -> np.ndarray:
        """Return the velocities after the explicit springs and what is applied [m/s]."""
        forces = total_forces(self.springs, self.positions, self.velocities)
        accelerations = forces / self.scene.node_mass * self.free[..., None]
        accelerations += self.gravity * self.free[..., None]
        # Forces act for the kick, but a push keeps its impulse.
        return (self.velocities + self._kick * accelerations
                + (end - begin) * self._push_accelerations(begin, end))


def split_evenly(remaining: float, longest: float) -> float:
    """Return the length of the next of the fewest equal parts that keep to ``longest`` [s]."""
    return remaining / max(math.ceil(remaining / longest - 1e-9), 1)
