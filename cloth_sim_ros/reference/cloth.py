# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What every reference mode shares: the state, its energies, the clock, the pushes, the pins."""

from abc import ABC
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass

from cloth_sim_ros.reference.cells import node_masses
from cloth_sim_ros.reference.edges import node_strain
from cloth_sim_ros.reference.edges import spring_sets
from cloth_sim_ros.reference.edges import SpringSet
from cloth_sim_ros.reference.forces import air_forces
from cloth_sim_ros.reference.forces import Bending
from cloth_sim_ros.reference.forces import push_acceleration
from cloth_sim_ros.reference.forces import push_nodes
from cloth_sim_ros.reference.forces import push_weight
from cloth_sim_ros.reference.forces import wind_at
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.scene import Scene
import numpy as np


@dataclass(frozen=True)
class Energies:
    """Kinetic, elastic and gravitational energy [J]; gravitational is zero at the origin."""

    kinetic: float
    elastic: float
    gravitational: float

    @property
    def total(self) -> float:
        """Return the sum of the three [J]."""
        return self.kinetic + self.elastic + self.gravitational


def kinetic_energy(velocities: np.ndarray, free: np.ndarray, masses: np.ndarray) -> float:
    """Return 1/2 m v^2 over the free nodes [J]; ``masses`` (rows, cols) [kg]."""
    return 0.5 * float(np.sum(masses[free, None] * velocities[free] ** 2))


def elastic_energy(springs: Sequence[SpringSet], positions: np.ndarray) -> float:
    """Return 1/2 k (l - L0)^2 over the springs [J]."""
    return sum(
        0.5 * spring_set.stiffness * float(np.sum(spring_set.shares * (
            spring_set.lengths(positions) - spring_set.rest_length) ** 2))
        for spring_set in springs)


def gravitational_energy(
        positions: np.ndarray, masses: np.ndarray, gravity: np.ndarray) -> float:
    """Return -m g . x over all nodes, the pinned ones too [J]; ``masses`` (rows, cols) [kg]."""
    return -float(np.sum(masses * (positions @ gravity)))


# Relative tolerance of times [1]: rounding of a sum of substeps.
_ROUNDED = 1e-12


class ReferenceCloth(ABC):
    """
    One cloth and its state; a mode adds how a step of dt is made.

    Pins move as ``move_pin`` says: the timed moves of a scene are left to the caller.

    :param scene: what is modelled; its timed pushes act at their times
    """

    def __init__(self, scene: Scene) -> None:
        """Start at rest in the scene's start pose."""
        self.scene = scene
        self.dt: float = scene['dt']
        self.springs = spring_sets(scene)
        self.bending = Bending(scene)
        # Springs with elastic energy; a mode that constrains edges removes those.
        self.elastic_springs = self.springs
        self.gravity = np.array(scene['gravity'])
        self.masses = node_masses(scene)
        # No node without a mass.
        self.free = ~scene.pinned_nodes() & (self.masses > 0.0)
        self._over_mass = np.divide(
            1.0, self.masses, out=np.zeros_like(self.masses), where=self.masses > 0.0)[..., None]
        self.positions = scene.start_positions()
        self.velocities = np.zeros_like(self.positions)
        self.steps = 0
        self._waiting = list(scene.timed_pushes())
        self._acting: list[tuple[Push, np.ndarray]] = []

    @property
    def time(self) -> float:
        """Return the simulated time [s]."""
        return self.steps * self.dt

    @property
    def inverse_masses(self) -> np.ndarray:
        """Return 1 / m of each node, 0 where it is pinned [1/kg], flat."""
        return (self.free * self._over_mass[..., 0]).ravel()

    def push(self, push: Push) -> None:
        """Add a push that acts at its own time."""
        self._waiting.append(push)

    def move_pin(self, row: int, col: int, velocity: np.ndarray) -> None:
        """Let the pinned node (row, col) move with ``velocity`` [m/s] from now on."""
        self.velocities[row, col] = velocity

    def step(self, count: int = 1) -> None:
        """Make ``count`` steps of dt."""
        for _ in range(count):
            self._step_of_dt()
            self.steps += 1

    def advance(self, seconds: float) -> None:
        """Make the whole steps of dt in ``seconds``."""
        self.step(round(seconds / self.dt))

    def energies(self) -> Energies:
        """Return the energies of the present state."""
        return Energies(
            kinetic_energy(self.velocities, self.free, self.masses),
            elastic_energy(self.elastic_springs, self.positions)
            + self.bending.energy(self.positions),
            gravitational_energy(self.positions, self.masses, self.gravity))

    def node_strain(self) -> np.ndarray:
        """Return the largest |l / L0 - 1| at each node, (rows, cols)."""
        return node_strain(self.springs, self.positions)

    @abstractmethod
    def _step_of_dt(self) -> None:
        """Step the state on by one dt."""

    def _load_accelerations(self, begin: float, end: float) -> np.ndarray:
        """Return what pushes and air add in the time given [s], 0 at pinned nodes [m/s2]."""
        pushes = self._push_accelerations(begin, end)
        return pushes + self._air_accelerations(begin, end) if self.scene.has_air else pushes

    def _air_accelerations(self, begin: float, end: float) -> np.ndarray:
        """Return the acceleration by the air, 0 at pinned nodes [m/s2]."""
        wind = wind_at(self.scene, begin, end)
        forces = air_forces(self.scene, self.positions, self.velocities, wind)
        return self.free[..., None] * forces * self._over_mass

    def _push_accelerations(self, begin: float, end: float) -> np.ndarray:
        """Return what the pushes add from ``begin`` to ``end`` [s], 0 at pinned nodes [m/s2]."""
        # The nodes of a push are settled once, by where they are when it begins.
        # The last substep may end later than its step by rounding.
        starting = [push for push in self._waiting if push.start < end * (1.0 - _ROUNDED)]
        for push in starting:
            self._waiting.remove(push)
            self._acting.append((push, push_nodes(push, self.positions, self.free)))
        return self._sum_of_pushes(self._acting, begin, end)

    def _applied_accelerations(self, begin: float, end: float) -> np.ndarray:
        """Return gravity, pushes and air at free nodes, 0 at pinned ones [m/s2]."""
        return self.gravity * self.free[..., None] + self._load_accelerations(begin, end)

    def _foreseen_velocities(self) -> np.ndarray:
        """Return the velocities after dt of gravity, pushes and air alone [m/s]."""
        # The pushes that begin within dt may still find other nodes: none is settled here.
        end = self.time + self.dt
        pushes = self._acting + [
            (push, push_nodes(push, self.positions, self.free))
            for push in self._waiting if push.start < end]
        applied = self.gravity * self.free[..., None] + self._sum_of_pushes(
            pushes, self.time, end) + self._air_accelerations(self.time, end)
        return self.velocities + self.dt * applied

    def _sum_of_pushes(
            self, pushes: list[tuple[Push, np.ndarray]], begin: float,
            end: float) -> np.ndarray:
        total = np.zeros_like(self.positions)
        for push, nodes in pushes:
            total += push_weight(push, begin, end) * push_acceleration(
                push, nodes, self.masses)
        return total
