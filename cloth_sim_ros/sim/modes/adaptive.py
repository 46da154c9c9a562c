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

"""Adaptive: springs within a strain limit, constraints at it (paper, section 4.3)."""

import math

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.modes.limit_marks import LimitMarks
from cloth_sim_ros.sim.modes.mode import Pieces
from cloth_sim_ros.sim.modes.one_pass import OnePass
from cloth_sim_ros.sim.modes.paper_limit import PaperLimit
from cloth_sim_ros.sim.modes.penalty_limit import PenaltyLimit
from cloth_sim_ros.sim.modes.spring_substeps import spring_substeps
from cloth_sim_ros.sim.modes.strain_limit import StrainLimit
from cloth_sim_ros.sim.modes.strain_watch import StrainWatch
from cloth_sim_ros.sim.modes.tension_limit import TensionLimit
from cloth_sim_ros.sim.push_field import PushField
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_fields import MOST_SUBSTEPS
from cloth_sim_ros.sim.stability import stability_limit
from cloth_sim_ros.sim.state import State
import numpy as np

# Of dt: a rest that is no substep any more.
_NOTHING = 1e-9


class Adaptive:
    """
    Mass-spring substeps while no edge comes near its limit, and limited ones while some do.

    ``substeps`` are those of the last step: limited substeps may have to be shorter.
    """

    name = 'adaptive'

    def __init__(self, scene: Scene, layout: Layout, *, check_stability: bool = True) -> None:
        """Choose the substeps and compile the passes."""
        self.spring_families = scene.families
        self.stability_limit = stability_limit(scene)
        self.substeps = spring_substeps(scene, self.name, check_stability=check_stability)
        self._dt: float = scene['dt']
        self._length = self._dt / self.substeps
        self._fewest_substeps = self.substeps
        self._springs = OnePass(scene, layout)
        self._watch = StrainWatch(scene, layout)
        self._limit = _make_limit(scene, layout, self._length, self._watch)
        self._marks = LimitMarks(scene, layout, self._limit)
        # Length of the last substep [s]; 0 where none was.
        self._before = 0.0

    @staticmethod
    def check(scene: Scene, *, check_stability: bool = True) -> None:
        """Raise ClothSimError when dt is too long for the springs of ``scene``."""
        spring_substeps(scene, Adaptive.name, check_stability=check_stability)

    def step(self, state: State, begin: float, pushes: PushField) -> Pieces:
        """Step ``state`` on by one dt."""
        done, substeps = 0.0, 0
        while self._dt - done > _NOTHING * self._dt:
            left = self._dt - done
            calm = 0
            if self._limit.is_idle:
                count = math.ceil(left / self._length - _NOTHING)
                length = left / count
                calm = min(count, self._watch.calm_substeps(
                    state, begin + done, length, pushes))
                self._limit.see(self._watch.seen)
            if calm:
                self._substep(self._springs, state, begin + done, length, pushes)
                for index in range(1, calm):
                    yield
                    start = begin + done + index * length
                    self._springs.substep(state, pushes.forcing(start, start + length), length)
                self._watch.spend(calm)
            else:
                length = self._next_length(begin + done, left, pushes)
                self._substep(self._limit, state, begin + done, length, pushes)
            done += max(calm, 1) * length
            substeps += max(calm, 1)
            yield
        self.substeps = substeps
        self._marks.update(state, some=not self._limit.is_idle)

    def run_all_passes(self, state: State, pushes: PushField) -> Pieces:
        """Make substeps with and without limit of a ``state`` that nobody needs."""
        self._watch.strains(state, pushes.still, self._length)
        yield
        for part in (self._springs, self._limit):
            self._substep(part, state, 0.0, self._length, pushes)
            yield
        self._marks.update(state, some=True)
        yield
        self.forget()

    def forget(self) -> None:
        """Hold no edge and expect nothing of the state."""
        self.substeps = self._fewest_substeps
        self._before = 0.0
        self._watch.forget()
        self._limit.forget()
        self._marks.forget()

    def report(self) -> dict[str, float]:
        """Return how many edges are at their limit, and how many changed in the last step."""
        return self._marks.count()

    def limit_marks(self) -> Buffer | None:
        """Return which edges are at their limit; None if none are."""
        return None if self._marks.are_empty else self._marks.buffer

    def tension(
            self, positions: np.ndarray, velocities: np.ndarray,
            nodes: np.ndarray | None = None) -> np.ndarray:
        """Return the tension of every edge, of its spring and of what holds it [N]."""
        return self._limit.tension(positions, velocities, nodes)

    def delete(self) -> None:
        """Give everything back."""
        for part in (self._springs, self._watch, self._limit, self._marks):
            part.delete()

    def _substep(
            self, part: OnePass | StrainLimit, state: State, start: float, length: float,
            pushes: PushField) -> None:
        # A velocity belongs to the middle of its substep, so forces act from there to the next.
        kick = length
        if self._before and abs(self._before - length) > _NOTHING * length:
            kick = 0.5 * (self._before + length)
        part.substep(state, pushes.forcing(start, start + length, kick), length, kick)
        self._before = length

    def _next_length(self, now: float, left: float, pushes: PushField) -> float:
        ahead = min(left, self._before or left)
        longest = self._limit.next_length(pushes.greatest_acceleration(now, now + ahead))
        # Also of a cloth that is about to blow up, a step comes to its end.
        longest = max(longest, self._dt / MOST_SUBSTEPS)
        return left / math.ceil(left / longest - _NOTHING)


def _make_limit(
        scene: Scene, layout: Layout, longest: float, watch: StrainWatch) -> StrainLimit:
    fixed = not scene['auto_substeps']
    if scene['adaptive.scheme'] == 'paper':
        return PaperLimit(scene, layout, longest, watch)
    if scene['adaptive.scheme'] == 'penalty':
        return PenaltyLimit(scene, layout, longest, watch, fixed=fixed)
    return TensionLimit(scene, layout, longest, fixed=fixed)
