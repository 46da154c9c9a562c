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

import math

from cloth_sim_ros.reference.cloth import ReferenceCloth
from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.reference.springs import total_forces
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# Bend springs may bend as far as they like: it is not a strain of the cloth.
LIMITED = ('structural', 'shear')


class LimitedCloth(ReferenceCloth):
    """
    Springs with a limit on the strain of the structural and shear ones.

    :param scene: what is modelled; its timed pushes act at their times
    :param limit: the strain beyond which an edge is held
    """

    def __init__(self, scene: Scene, limit: float) -> None:
        """Start at rest in the scene's start pose."""
        super().__init__(scene)
        self.limit = limit
        self.edges = edges_of(scene)
        weights = self.inverse_masses
        self.weight_sums = weights[self.edges.first] + weights[self.edges.second]
        self.limited = self.edges.of(LIMITED) & (self.weight_sums > 0.0)
        # Of the last dt: which edges were held at its end, the share of the limited ones that
        # changed since the end of the dt before, and the substeps.
        self.active = np.zeros(len(self.edges), bool)
        self.switched = 0.0
        self.substeps = 0

    def max_strain(self) -> float:
        """Return the largest |l / L0 - 1| of the limited edges."""
        strains = np.abs(self.edges.strains(self._flat_positions))
        return float(np.max(strains[self.limited], initial=0.0))

    @property
    def _flat_positions(self) -> np.ndarray:
        return self.positions.reshape(-1, 3)

    def _note_active(self, active: np.ndarray) -> None:
        changed = np.count_nonzero(active != self.active)
        self.switched = changed / max(np.count_nonzero(self.limited), 1)
        self.active = active

    def _spring_velocities(self, begin: float, end: float) -> np.ndarray:
        """Return the velocities after the explicit springs and what is applied [m/s]."""
        forces = total_forces(self.springs, self.positions, self.velocities)
        accelerations = forces / self.scene.node_mass * self.free[..., None]
        accelerations += self._applied_accelerations(begin, end)
        return self.velocities + (end - begin) * accelerations


def split_evenly(remaining: float, longest: float) -> float:
    """Return the length of the next of the fewest equal parts that keep to ``longest`` [s]."""
    return remaining / max(math.ceil(remaining / longest - 1e-9), 1)
