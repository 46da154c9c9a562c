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

"""Mass-spring cloth, symplectic Euler, float64: the same scheme as the shaders."""

from cloth_sim_ros.reference.energy import elastic_energy
from cloth_sim_ros.reference.energy import Energies
from cloth_sim_ros.reference.energy import gravitational_energy
from cloth_sim_ros.reference.energy import kinetic_energy
from cloth_sim_ros.reference.push_force import push_acceleration
from cloth_sim_ros.reference.push_force import push_nodes
from cloth_sim_ros.reference.push_force import push_weight
from cloth_sim_ros.reference.springs import spring_sets
from cloth_sim_ros.reference.springs import total_forces
from cloth_sim_ros.reference.strain import node_strain
from cloth_sim_ros.sim.push import Push
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.stability import choose_substeps
import numpy as np


class MassSpringReference:
    """
    One cloth and its state.

    Each substep of length h does v += h (g + a_push + F / m), then x += h v, on free nodes.

    :param scene: what is modelled; its timed pushes act at their times
    :param substeps: substeps in each dt; the scene's own choice when not given
    """

    def __init__(self, scene: Scene, substeps: int | None = None) -> None:
        """Start at rest in the scene's start pose."""
        self.scene = scene
        self.dt: float = scene['dt']
        self.substeps = substeps or self._substeps_of_scene()
        self.springs = spring_sets(scene)
        self.gravity = np.array(scene['gravity'])
        self.free = ~scene.pinned_nodes()
        self.positions = scene.start_positions()
        self.velocities = np.zeros_like(self.positions)
        self.steps = 0
        self._waiting = list(scene.timed_pushes())
        self._acting: list[tuple[Push, np.ndarray]] = []

    @property
    def time(self) -> float:
        """Return the simulated time [s]."""
        return self.steps * self.dt

    def push(self, push: Push) -> None:
        """Add a push that acts at its own time."""
        self._waiting.append(push)

    def step(self, count: int = 1) -> None:
        """Make ``count`` steps of dt."""
        for _ in range(count):
            for substep in range(self.substeps):
                begin = (self.steps + substep / self.substeps) * self.dt
                end = (self.steps + (substep + 1) / self.substeps) * self.dt
                self._substep(begin, end)
            self.steps += 1

    def advance(self, seconds: float) -> None:
        """Make the whole steps of dt in ``seconds``."""
        self.step(round(seconds / self.dt))

    def accelerations(self, positions: np.ndarray, velocities: np.ndarray) -> np.ndarray:
        """Return g + F / m at free nodes and 0 at pinned ones [m/s2], without the pushes."""
        forces = total_forces(self.springs, positions, velocities)
        return (self.gravity + forces / self.scene.node_mass) * self.free[..., None]

    def right_hand_side(self, t: float, state: np.ndarray) -> np.ndarray:
        """
        Return d(state)/dt of the same cloth in continuous time, for scipy's solve_ivp.

        :param t: not used: pushes are steps in time, which such a solver cannot cross
        :param state: positions then velocities, flat
        """
        positions, velocities = state.reshape(2, *self.positions.shape)
        moving = velocities * self.free[..., None]
        return np.concatenate(
            (moving.ravel(), self.accelerations(positions, moving).ravel()))

    def energies(self) -> Energies:
        """Return the energies of the present state."""
        return Energies(
            kinetic_energy(self.velocities, self.free, self.scene.node_mass),
            elastic_energy(self.springs, self.positions),
            gravitational_energy(self.positions, self.scene.node_mass, self.gravity))

    def node_strain(self) -> np.ndarray:
        """Return the largest |l / L0 - 1| at each node, (rows, cols)."""
        return node_strain(self.springs, self.positions)

    def _substeps_of_scene(self) -> int:
        return choose_substeps(self.scene) if self.scene['auto_substeps'] else (
            self.scene['substeps'])

    def _substep(self, begin: float, end: float) -> None:
        acceleration = self.accelerations(self.positions, self.velocities)
        self._start_pushes(end)
        for push, nodes in self._acting:
            acceleration += push_weight(push, begin, end) * push_acceleration(
                push, nodes, self.scene.node_mass)
        length = end - begin
        self.velocities += length * acceleration
        self.positions += length * self.velocities * self.free[..., None]

    def _start_pushes(self, end: float) -> None:
        # The nodes of a push are settled once, by where they are when it begins.
        starting = [push for push in self._waiting if push.start < end]
        for push in starting:
            self._waiting.remove(push)
            self._acting.append((push, push_nodes(push, self.positions, self.free)))
