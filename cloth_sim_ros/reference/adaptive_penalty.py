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

import math

from cloth_sim_ros.reference.limited_cloth import LIMITED
from cloth_sim_ros.reference.limited_cloth import LimitedCloth
from cloth_sim_ros.reference.limited_cloth import split_evenly
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.stability import any_shape_limit
from cloth_sim_ros.sim.stability import safe_substep
from cloth_sim_ros.sim.stability import SAFETY
from cloth_sim_ros.sim.stability import stability_limit
import numpy as np

# Strains this close to the limit count as near it.
_NEAR = 0.95
# How far ahead strains are foreseen, in substeps.
_AHEAD = 4.0
# An overshoot of this strain leaves the extra stiffness as it is; more raises it.
_OVERSHOOT = 0.015
_MOST_GROWTH = 1.25
_DECAY = 0.998
# Below this part of _OVERSHOOT the extra stiffness decays.
_LITTLE = 0.4
# The extra stiffness starts at this many times the springs' and ends below half of that.
_START = 4.0
# At its greatest, this many times the cloth's weight stretches an edge by 1 %.
_CAP = 5.0


class PenaltyAdaptiveReference(LimitedCloth):
    """
    Explicit springs with the stiffness k up to the limit and k + k_l beyond it.

    The force is continuous at the limit. k_l is 0 until an edge comes near its limit, and
    then follows the overshoot; substeps follow k_l. Pair forces only: momentum is kept.

    :param scene: what is modelled; its timed pushes act at their times
    :param limit: the strain beyond which springs are stiffer
    """

    def __init__(self, scene: Scene, limit: float = 0.1) -> None:
        """Start at rest in the scene's start pose."""
        super().__init__(scene, limit)
        self.extra_stiffness = 0.0
        self.base_substep = safe_substep(scene)
        stiffest = float(np.max(self.edges.stiffness, initial=0.0))
        self._least = _START * stiffest
        weight = scene.node_mass * scene.node_count * float(np.linalg.norm(self.gravity))
        shortest = float(np.min(self.edges.rest_length, initial=math.inf))
        self._most = _CAP * max(weight, scene.node_mass * 9.81) / (0.01 * shortest)
        self._substep_now = self.base_substep
        self._waves = [_wave_stiffness(scene, limit) for limit in (
            stability_limit, any_shape_limit)]

    def _step_of_dt(self) -> None:
        end = (self.steps + 1) * self.dt
        now = self.time
        count = 0
        while end - now > 1e-9 * self.dt:
            self._adapt()
            h = split_evenly(end - now, self._substep_now)
            self._substep(now, now + h)
            now += h
            count += 1
        self.substeps = count
        strains = np.abs(self.edges.strains(self._flat_positions))
        self._note_active(self.limited & (strains > self.limit))

    def _adapt(self) -> None:
        """Choose k_l and the substep from the strains now and a little ahead."""
        edges = self.edges
        positions = self._flat_positions
        ahead = positions + _AHEAD * self._substep_now * self.velocities.reshape(-1, 3)
        now, soon = (
            float(np.max(np.abs(edges.strains(x)[self.limited]), initial=0.0))
            for x in (positions, ahead))
        extra = self.extra_stiffness
        if max(now, soon) < _NEAR * self.limit:
            extra *= _DECAY
        else:
            overshoot = (now - self.limit) / _OVERSHOOT
            extra = max(extra, self._least)
            if overshoot > 1.0:
                extra *= min(_MOST_GROWTH, overshoot)
            elif overshoot < _LITTLE:
                extra *= _DECAY
        extra = min(extra, self._most)
        self.extra_stiffness = extra if extra >= 0.5 * self._least else 0.0
        self._substep_now = self._longest_substep()

    def _longest_substep(self) -> float:
        """Return the safe substep [s] with the extra stiffness in all limited springs."""
        if self.extra_stiffness == 0.0:
            return self.base_substep
        lengths = []
        for (kappa, gamma, unit), safety in zip(self._waves, (SAFETY, 1.0)):
            total = kappa + self.extra_stiffness * unit
            mass = self.scene.node_mass
            lengths.append(
                safety * 4.0 * mass / (gamma + math.sqrt(gamma**2 + 4.0 * mass * total)))
        return min(self.base_substep, *lengths)

    def _substep(self, begin: float, end: float) -> None:
        velocities = self._spring_velocities(begin, end)
        if self.extra_stiffness > 0.0:
            edges = self.edges
            positions = self._flat_positions
            error = edges.lengths(positions) - edges.rest_length
            reach = self.limit * edges.rest_length
            beyond = np.where(self.limited, error - np.clip(error, -reach, reach), 0.0)
            pull = (self.extra_stiffness * beyond)[:, None] * edges.directions(positions)
            forces = -edges.scatter(pull, len(positions))
            velocities += (end - begin) * (
                self.inverse_masses[:, None] * forces).reshape(velocities.shape)
        self.velocities = velocities
        self.positions = self.positions + (end - begin) * velocities


def _wave_stiffness(scene: Scene, limit) -> tuple[float, float, float]:
    """
    Return the greatest stiffness and damping a wave feels, and the stiffness from k_l = 1.

    A sum of greatest values is not below the greatest value of a sum, so a substep from these
    is safe for any k_l without going through the waves again.
    """
    springs = {f'stiffness.{family}': scene.stiffness(family) for family in FAMILIES}
    damping = {f'stiffness.{family}': scene.damping(family) for family in FAMILIES}
    extra = {f'stiffness.{family}': float(family in LIMITED) for family in FAMILIES}
    undamped = {f'damping.{family}': 0.0 for family in FAMILIES}
    greatest = []
    for values in (springs, damping, extra):
        longest = limit(Scene({**scene.values, **undamped, **values}))
        greatest.append(4.0 * scene.node_mass / longest**2)
    return tuple(greatest)
