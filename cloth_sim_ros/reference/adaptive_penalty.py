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

"""The adaptive scheme `penalty`: beyond the limit springs are stiffer, as much as it takes."""

from cloth_sim_ros.reference.limited_cloth import LIMITED
from cloth_sim_ros.reference.limited_cloth import LimitedCloth
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.stability import StiffenedLimit
import numpy as np

# Of the limit: strains this close to it count as near.
_NEAR = 0.95
# How far ahead strains are foreseen, in substeps.
_AHEAD = 4.0
# Of the limit: an overshoot that leaves the extra stiffness as it is; more raises it.
_OVERSHOOT = 0.15
_MOST_GROWTH = 1.25
_DECAY = 0.998
# Below this part of _OVERSHOOT the extra stiffness decays.
_LITTLE = 0.4
# The extra stiffness starts at this many times the springs' and ends below half of that.
_START = 4.0
# At its greatest, this many times the cloth's weight stretches an edge by a tenth of the limit.
_CAP = 5.0


class PenaltyAdaptiveReference(LimitedCloth):
    """
    Explicit springs with the stiffness k up to the limit and k + k_l beyond it.

    The force is continuous at the limit. k_l is 0 until an edge comes near its limit, and
    then follows the overshoot; substeps follow k_l. Pair forces only: momentum is kept.

    :param scene: what is modelled; its timed pushes act at their times
    :param limit: the strain beyond which springs are stiffer, if not the scene's
    """

    def __init__(self, scene: Scene, limit: float | None = None) -> None:
        """Start at rest in the scene's start pose."""
        super().__init__(scene, limit)
        self.extra_stiffness = 0.0
        self._stability = StiffenedLimit(scene)
        stiffest = max(scene.stiffness(family) for family in LIMITED)
        weight = scene.node_mass * scene.node_count * max(
            float(np.linalg.norm(self.gravity)), 9.81)
        most = _CAP * weight / (0.1 * self.limit * min(scene.spacing))
        self._least = min(_START * stiffest, most) or most / 100.0
        self._most = max(most, self._least)
        self._length = self._safe_substep()

    @property
    def is_idle(self) -> bool:
        """Tell whether the springs have their own stiffness."""
        return self.extra_stiffness == 0.0

    def _held(self) -> np.ndarray:
        return self.limited & (np.abs(self.edges.strains(self._flat_positions)) > self.limit)

    def _next_length(self, acceleration: float) -> float:
        return self._length

    def _limited_substep(self, begin: float, end: float) -> None:
        if self.is_idle:
            self.extra_stiffness = self._least
        edges = self.edges
        positions = self._flat_positions
        velocities = self._spring_velocities(begin, end)
        error = edges.lengths(positions) - edges.rest_length
        reach = self.limit * edges.rest_length
        beyond = np.where(
            edges.of(LIMITED), error - np.clip(error, -reach, reach), 0.0)
        pull = (self.extra_stiffness * beyond)[:, None] * edges.directions(positions)
        forces = -edges.scatter(pull, len(positions))
        velocities += self._kick * (
            self.inverse_masses[:, None] * forces).reshape(velocities.shape)
        self.velocities = velocities
        self.positions = self.positions + (end - begin) * velocities
        self._adapt(*self._foresee(begin, _AHEAD * (end - begin), end - begin, self._kick))

    def _adapt(self, now: float, soon: float) -> None:
        """Choose k_l and the substep from the strains now and a little ahead."""
        extra = self.extra_stiffness
        if max(now, soon) < _NEAR * self.limit:
            extra *= _DECAY
        else:
            overshoot = (now - self.limit) / (_OVERSHOOT * self.limit)
            extra = max(extra, self._least)
            if overshoot > 1.0:
                extra *= min(_MOST_GROWTH, overshoot)
            elif overshoot < _LITTLE:
                extra *= _DECAY
        extra = min(extra, self._most)
        self.extra_stiffness = extra if extra >= 0.5 * self._least else 0.0
        self._length = self._safe_substep()

    def _safe_substep(self) -> float:
        if self.fixed:
            return self.spring_substep
        return min(
            self.spring_substep,
            self._stability.safe_substep(self.extra_stiffness or self._least))
