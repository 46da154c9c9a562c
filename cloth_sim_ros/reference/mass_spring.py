# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Mass-spring cloth, symplectic Euler, float64: the same scheme as the shaders."""

from cloth_sim_ros.reference.air_force import air_forces
from cloth_sim_ros.reference.cloth import ReferenceCloth
from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.stability import choose_substeps
import numpy as np


class MassSpringReference(ReferenceCloth):
    """
    One cloth and its state.

    Each substep of length h does v += h (g + a_push + F / m), then x += h v, on free nodes.

    :param scene: what is modelled; its timed pushes act at their times
    :param substeps: substeps in each dt; the scene's own choice when not given
    """

    def __init__(self, scene: Scene, substeps: int | None = None) -> None:
        """Start at rest in the scene's start pose."""
        super().__init__(scene)
        self._edges = edges_of(scene)
        self.substeps = substeps or self._substeps_of_scene()

    def accelerations(self, positions: np.ndarray, velocities: np.ndarray) -> np.ndarray:
        """Return g + F / m, 0 at pinned nodes [m/s2]; no pushes and no air."""
        forces = self._edges.spring_forces(positions.reshape(-1, 3), velocities.reshape(-1, 3))
        if self.scene.has_rigidity:
            forces += self.bending.forces(positions).reshape(-1, 3)
            forces += self.bending.damping_forces(positions, velocities).reshape(-1, 3)
        forces *= self.inverse_masses[:, None]
        return self.gravity * self.free[..., None] + forces.reshape(positions.shape)

    def right_hand_side(self, t: float, state: np.ndarray) -> np.ndarray:
        """
        Return d(state)/dt of the same cloth in continuous time, for scipy's solve_ivp.

        :param t: not used: pushes and gusts are steps in time, which such a solver cannot cross
        :param state: positions then velocities, flat
        """
        positions, velocities = state.reshape(2, *self.positions.shape)
        moving = velocities * self.free[..., None]
        wind = np.array(self.scene['air.wind'])
        air = air_forces(self.scene, positions, moving, wind) / self.scene.node_mass
        accelerations = self.accelerations(positions, moving) + air * self.free[..., None]
        return np.concatenate((moving.ravel(), accelerations.ravel()))

    def _substeps_of_scene(self) -> int:
        return choose_substeps(self.scene) if self.scene['auto_substeps'] else (
            self.scene['substeps'])

    def _step_of_dt(self) -> None:
        for substep in range(self.substeps):
            begin = (self.steps + substep / self.substeps) * self.dt
            end = (self.steps + (substep + 1) / self.substeps) * self.dt
            self._substep(begin, end)

    def _substep(self, begin: float, end: float) -> None:
        acceleration = self.accelerations(self.positions, self.velocities)
        acceleration += self._load_accelerations(begin, end)
        self.velocities += (end - begin) * acceleration
        self.positions += (end - begin) * self.velocities
