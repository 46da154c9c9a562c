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

"""Limit the strain by a stiffer spring beyond it: explicit, with stiffness and substeps to fit."""

from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.modes.one_pass import OnePass
from cloth_sim_ros.sim.modes.strain_watch import StrainWatch
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.spring_tension import spring_tension
from cloth_sim_ros.sim.stability import StiffenedLimit
from cloth_sim_ros.sim.state import State
import numpy as np

_GRAVITY = 9.81
# Substeps that the strain is predicted ahead.
_AHEAD = 4.0
# Of the limit: a strain above this keeps the stiffness up.
_NEAR = 0.95
# Of the limit: the overshoot that is aimed at.
_OVERSHOOT = 0.15
_GROWTH = 1.25
_DECAY = 0.998
# The first stiffness over that of the springs.
_FIRST = 4.0
_MOST_WEIGHTS = 5.0


class PenaltyLimit:
    """
    Springs that stiffen beyond the limit, as much as the overshoot asks for.

    :param longest: substep that the springs allow [s]
    :param watch: measures the strain
    """

    tensions = None

    def __init__(
            self, scene: Scene, layout: Layout, longest: float, watch: StrainWatch, *,
            fixed: bool) -> None:
        """Compile the pass."""
        self._scene = scene
        self._limit: float = scene['adaptive.threshold']
        self._longest = longest
        self._fixed = fixed
        self._watch = watch
        self._stability = StiffenedLimit(scene)
        self._springs = OnePass(scene, layout, 'PENALTY_LIMIT')
        stiffest = max(scene.stiffness('structural'), scene.stiffness('shear'))
        weight = scene.node_mass * scene.node_count * max(
            _GRAVITY, float(np.linalg.norm(scene['gravity'])))
        most = _MOST_WEIGHTS * weight / (0.1 * self._limit * min(scene.spacing))
        # Springs of no stiffness need some to begin with.
        self._first = min(_FIRST * stiffest, most) or most / 100.0
        self._most = max(most, self._first)
        self.forget()

    @property
    def is_idle(self) -> bool:
        """Tell whether the springs have their own stiffness."""
        return self._penalty == 0.0

    def see(self, strain: float) -> None:
        """Take no notice: the stiffness follows the strain."""

    def next_length(self, acceleration: float) -> float:
        """Return the longest substep that may come next [s]."""
        return self._length

    def substep(self, state: State, forcing: Forcing, length: float, kick: float) -> None:
        """Step ``state`` on by ``length`` [s], with forces that act for ``kick`` [s]."""
        if self.is_idle:
            self._penalty = self._first
        self._springs.run(state, forcing, length, kick, penalty=self._penalty)
        state.swap()
        self._adjust(*self._watch.strains(state, forcing, _AHEAD * length))

    def tension(
            self, positions: np.ndarray, velocities: np.ndarray,
            nodes: np.ndarray | None = None) -> np.ndarray:
        """Return the tension of every spring, as stiff as it is now beyond the limit [N]."""
        return spring_tension(
            self._scene, positions, velocities, nodes, penalty=self._penalty)

    def forget(self) -> None:
        """Give the springs their own stiffness."""
        self._penalty = 0.0
        self._length = self._substep_with(self._first)

    def delete(self) -> None:
        """Give nothing back: the pass allocates nothing."""

    def _adjust(self, now: float, ahead: float) -> None:
        if max(now, ahead) < _NEAR * self._limit:
            self._penalty *= _DECAY
        else:
            overshoot = (now - self._limit) / (_OVERSHOOT * self._limit)
            self._penalty = max(self._penalty, self._first)
            if overshoot > 1.0:
                self._penalty *= min(_GROWTH, overshoot)
            elif overshoot < 0.4:
                self._penalty *= _DECAY
        self._penalty = min(self._penalty, self._most)
        if self._penalty < 0.5 * self._first:
            self._penalty = 0.0
        self._length = self._substep_with(self._penalty or self._first)

    def _substep_with(self, penalty: float) -> float:
        if self._fixed:
            return self._longest
        return min(self._longest, self._stability.safe_substep(penalty))
