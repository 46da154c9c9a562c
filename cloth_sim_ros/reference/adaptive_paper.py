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

"""The paper's adaptive scheme: a spring within the limit, a hard edge at rest length beyond."""

from cloth_sim_ros.reference.limited_cloth import LimitedCloth
from cloth_sim_ros.reference.solve import solve_dual
from cloth_sim_ros.sim.scene import Scene
import numpy as np


class PaperAdaptiveReference(LimitedCloth):
    """
    The scheme to compare with: it is known to fail at larger steps.

    Its explicit springs have their own stability limit, and an edge that passes the limit is
    pulled all the way to rest length within one step.

    :param scene: what is modelled; its timed pushes act at their times
    :param limit: the strain beyond which an edge is a constraint, if not the scene's
    :param delta: regularisation of the constraints, over the sum of their inverse masses
    """

    def __init__(self, scene: Scene, limit: float | None = None, delta: float = 1e-3) -> None:
        """Start at rest in the scene's start pose."""
        super().__init__(scene, limit)
        self.delta = delta

    @property
    def is_idle(self) -> bool:
        """Tell whether no edge is beyond the limit."""
        return not self._held().any()

    def _held(self) -> np.ndarray:
        error = self.edges.lengths(self._flat_positions) - self.edges.rest_length
        return self.limited & (np.abs(error) > self.limit * self.edges.rest_length)

    def _next_length(self, acceleration: float) -> float:
        return self.spring_substep

    def _limited_substep(self, begin: float, end: float) -> None:
        h = end - begin
        edges = self.edges
        start = self._flat_positions
        directions = edges.directions(start)
        lengths = edges.lengths(start)
        error = lengths - edges.rest_length
        active = self._held()
        springs = ~active
        rate = np.sum(edges.differences(self.velocities.reshape(-1, 3)) * directions, axis=1)
        tension = springs * (edges.stiffness * error + edges.damping * rate)
        forces = -edges.scatter(tension[:, None] * directions, len(start))
        velocities = self.velocities + h * (
            self._applied_accelerations(begin, end)
            + (self.inverse_masses[:, None] * forces).reshape(self.positions.shape))
        if active.any():
            # Of Phi = |d|^2 - L0^2, over |J| = 2 l: the paper's constraint, with unit rows.
            squares = (lengths[active]**2 - edges.rest_length[active]**2) / (
                2.0 * lengths[active])
            jacobian = edges.jacobian(directions, len(start))[active]
            residual = squares / h**2 + jacobian @ velocities.ravel() / h
            change, _ = solve_dual(
                jacobian, np.repeat(self.inverse_masses, 3),
                self.delta * self.weight_sums[active], residual, h)
            velocities = velocities + change.reshape(velocities.shape)
        self.velocities = velocities
        self.positions = self.positions + h * velocities
