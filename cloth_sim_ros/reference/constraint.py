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

"""Constraint enforcement: edges keep their length by tensions solved for in each step."""

from dataclasses import dataclass
import math

from cloth_sim_ros.reference.cloth import ReferenceCloth
from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.reference.solve import Solve
from cloth_sim_ros.reference.solve import solve_dual
from cloth_sim_ros.reference.substeps import across_edges
from cloth_sim_ros.reference.substeps import geometric_substep
from cloth_sim_ros.reference.substeps import turn_substep
from cloth_sim_ros.sim.scene import Scene
import numpy as np


@dataclass(frozen=True)
class ConstraintOptions:
    """
    How the constraint mode works.

    :param hard: families that keep their length; the others the scene models are implicit
        springs with their stiffness and damping, in the same system
    :param newton_iterations: linear solves in a substep; 1 is the paper's method, each further
        one starts from the edges where the one before left them
    :param foresee_turn: where further solves follow, let the first allow for how much longer
        edges get by turning; without it they take speed from what turns
    :param delta: regularisation of hard edges, over the sum of their inverse masses
    :param substeps: in each dt; None takes them from how fast edges turn and how tight they are
    :param max_substeps: the most that are taken so
    :param solve: solve_dual or solve_primal
    """

    hard: tuple[str, ...] = ('structural', 'shear')
    newton_iterations: int = 2
    foresee_turn: bool = True
    delta: float = 1e-3
    substeps: int | None = None
    max_substeps: int = 32
    solve: Solve = solve_dual


class ConstraintReference(ReferenceCloth):
    """
    One cloth whose hard edges keep their length.

    :param scene: what is modelled; its timed pushes act at their times
    """

    def __init__(self, scene: Scene, options: ConstraintOptions | None = None) -> None:
        """Start at rest in the scene's start pose."""
        super().__init__(scene)
        self.options = options or ConstraintOptions()
        self.edges = edges_of(scene, always=self.options.hard)
        self.hard = self.edges.of(self.options.hard)
        self.elastic_springs = tuple(
            springs for springs in self.springs if springs.family not in self.options.hard)
        # Last made: the tension of each edge in the last substep [N], the substeps of the
        # last dt, and the force of each pin on the cloth over the last dt [N].
        self.tension = np.zeros(len(self.edges))
        self.substeps = 0
        self._limit_before = math.inf
        self.reactions = np.zeros_like(self.positions)
        self._pin_impulse = np.zeros_like(self.positions)

    def move_pin(self, row: int, col: int, velocity: np.ndarray) -> None:
        """Let the pinned node (row, col) move with ``velocity`` [m/s] from now on."""
        # Its own mass has to be sped up, too: whoever holds the pin does it.
        change = np.asarray(velocity) - self.velocities[row, col]
        self._pin_impulse[row, col] += self.scene.node_mass * change
        super().move_pin(row, col, velocity)

    def violation(self) -> float:
        """Return the largest |l / L0 - 1| of the hard edges."""
        strains = self.edges.strains(self.positions.reshape(-1, 3))
        return float(np.max(np.abs(strains[self.hard]), initial=0.0))

    def _step_of_dt(self) -> None:
        self.substeps = self.options.substeps or self._choose_substeps()
        for substep in range(self.substeps):
            begin = (self.steps + substep / self.substeps) * self.dt
            end = (self.steps + (substep + 1) / self.substeps) * self.dt
            self._substep(begin, end)
        self.reactions = self._pin_impulse / self.dt
        self._pin_impulse = np.zeros_like(self._pin_impulse)

    def _choose_substeps(self) -> int:
        foreseen = self._foreseen_velocities().reshape(-1, 3)
        longest = min(
            turn_substep(self.edges, self.positions.reshape(-1, 3), foreseen),
            self._foresee_limit())
        wanted = math.ceil(self.dt / longest - 1e-9)
        return min(max(wanted, 1), self.options.max_substeps)

    def _foresee_limit(self) -> float:
        limit = geometric_substep(self.edges, self.tension, self.inverse_masses)
        before, self._limit_before = self._limit_before, limit
        # It shrinks by more than a fifth a dt while edges are being caught, and goes on so.
        return limit * max(limit / before, 0.6) if limit < 0.8 * before < math.inf else limit

    def _substep(self, begin: float, end: float) -> None:
        """
        Make one substep; all rows at once, with J at the present estimate of the new positions.

        A row says lambda = k C + k_d dC/dt at the end of the substep. With compliance
        E = 1 / (h^2 k + h k_d) and beta = h k / (h k + k_d), its residual there is
        (C - (1 - beta) C(x)) / h^2 - E lambda. A hard row has k without end: beta = 1, and its
        E = delta (w_i + w_j) only regularises.
        """
        h = end - begin
        edges = self.edges
        inverse_masses = self.inverse_masses
        start = self.positions.reshape(-1, 3)
        applied = self._applied_accelerations(begin, end)
        velocities = (self.velocities + h * applied).reshape(-1, 3)
        compliance, beta = self._compliance(h)
        start_error = edges.lengths(start) - edges.rest_length
        tension = np.zeros(len(edges))
        pull = np.zeros_like(start)
        for iteration in range(self.options.newton_iterations):
            if iteration == 0:
                # Linearised at x: C + J (x+ - x) for the velocities without tension, and
                # the part of C that is second order in the step.
                at, error = start, beta * start_error + self._turn(start, velocities, h)
                jacobian = edges.jacobian(edges.directions(at), len(at))
                residual = error / h**2 + jacobian @ velocities.ravel() / h
            else:
                at = start + h * velocities
                error = edges.lengths(at) - edges.rest_length - (1.0 - beta) * start_error
                jacobian = edges.jacobian(edges.directions(at), len(at))
                residual = error / h**2 - np.where(self.hard, 0.0, compliance * tension)
            used = self._used(at)
            if not used.any():
                break
            jacobian = jacobian[used]
            change, added = self.options.solve(
                jacobian, np.repeat(inverse_masses, 3), compliance[used], residual[used], h)
            velocities = velocities + change.reshape(-1, 3)
            tension[used] += added
            pull += (jacobian.T @ added).reshape(-1, 3)
        self.tension = tension
        self.velocities = velocities.reshape(self.positions.shape)
        self.positions = self.positions + h * self.velocities
        held = pull.reshape(self.positions.shape) - self.scene.node_mass * self.gravity
        self._pin_impulse += h * held * ~self.free[..., None]

    def _turn(self, start: np.ndarray, velocities: np.ndarray, h: float) -> np.ndarray:
        """Return how much longer each edge gets by moving across its direction [m]."""
        if not self.options.foresee_turn or self.options.newton_iterations == 1:
            return np.zeros(len(self.edges))
        across = h * across_edges(self.edges, start, velocities)
        lengths = self.edges.lengths(start)
        return np.sqrt(lengths**2 + np.sum(across**2, axis=1)) - lengths

    def _compliance(self, h: float) -> tuple[np.ndarray, np.ndarray]:
        """Return E [1/kg] and beta of each edge for a substep of ``h`` [s]."""
        weights = self.inverse_masses[self.edges.first] + self.inverse_masses[self.edges.second]
        stiff = h * self.edges.stiffness
        total = np.where(self.hard, 1.0, stiff + self.edges.damping)
        compliance = np.where(self.hard, self.options.delta * weights, 1.0 / (h * total))
        return compliance, np.where(self.hard, 1.0, stiff / total)

    def _used(self, positions: np.ndarray) -> np.ndarray:
        """Return which rows say anything: one end is free and the edge has a direction."""
        free = self.free.ravel()
        movable = free[self.edges.first] | free[self.edges.second]
        return movable & (self.edges.lengths(positions) > 0.0)
