# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A cloth stepped by ``ImplicitStep``: its substeps, its pins, and what could not be met."""

from dataclasses import dataclass
import math

from cloth_sim_ros.reference.cloth import Energies
from cloth_sim_ros.reference.cloth import gravitational_energy
from cloth_sim_ros.reference.cloth import kinetic_energy
from cloth_sim_ros.reference.cloth import ReferenceCloth
from cloth_sim_ros.reference.edge_law import constraint_law
from cloth_sim_ros.reference.edge_law import EdgeLaw
from cloth_sim_ros.reference.edges import Edges
from cloth_sim_ros.reference.implicit_step import ImplicitStep
from cloth_sim_ros.reference.implicit_step import Passes
from cloth_sim_ros.reference.implicit_step import passes_of
from cloth_sim_ros.reference.implicit_step import Step
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# Max. relative change of an edge's length by its rotation in one substep, (omega h)^2 / 2 [1]: the
# mean over all edges, weighted with the energy that each loses by it, and the largest.
MEAN_TURN = 0.002
LARGEST_TURN = 0.0075


def across_edges(edges: Edges, positions: np.ndarray, velocities: np.ndarray) -> np.ndarray:
    """Return the velocity of each edge's first end past its second, across the edge [m/s]."""
    return edges.across(velocities, edges.directions(positions))


def turn_substep(edges: Edges, positions: np.ndarray, velocities: np.ndarray) -> float:
    """
    Return the longest substep [s] in which edges turn no more than both bounds.

    One linear solve leaves an edge that turns at omega longer by (omega h)^2 / 2, as its force
    acts along where the edge was; and of the energy with which it turns it loses such a share.

    :param velocities: foreseen at the end of the step [m/s]
    """
    squares = np.sum(across_edges(edges, positions, velocities)**2, axis=1)
    if not squares.any():
        return math.inf
    turns = squares / edges.rest_length**2
    return math.sqrt(2.0 / max(
        turns.max() / LARGEST_TURN, np.average(turns, weights=squares * turns) / MEAN_TURN))


# Fraction of a substep that counts as rounding [1]: no further substep is made for it.
_SUBSTEP_ROUNDING = 1e-9


@dataclass(frozen=True)
class Report:
    """
    The work of the last dt.

    :param substeps: that were made
    :param solves: linear solves in them
    :param settled: whether the limits in force were found in each pass
    :param stopped: pins that stood still as they pulled too much, bool (rows, cols)
    """

    substeps: int
    solves: int
    settled: bool
    stopped: np.ndarray


class ImplicitCloth(ReferenceCloth):
    """
    One cloth whose edges follow one law: hard, limited or springs.

    A dt has equal substeps, as mode constraint has: so many that no edge turns too far in one, or
    ``substeps`` of the scene where it has no ``auto_substeps``.

    :param scene: what is modelled; its timed pushes act at their times
    :param law: of the edges; None takes that of mode constraint
    :param passes: of each substep; None takes those of mode constraint
    :param max_force: beyond which a pin does not move [N]: it stands still while the edges would
        pull more, and goes on when they do not. A pin that stands holds any force.
    :raises ClothSimError: for a ``max_force`` that is not above 0
    """

    def __init__(
            self, scene: Scene, law: EdgeLaw | None = None, *, passes: Passes | None = None,
            max_force: float = math.inf) -> None:
        """Start at rest in the scene's start pose."""
        super().__init__(scene)
        if not max_force > 0.0:
            raise ClothSimError(
                f'max_force must be above 0 N, got {max_force}: leave it out for pins that pull '
                'with any force')
        self.law = law or constraint_law(scene)
        self.max_force = max_force
        self.tension = np.zeros(len(self.law.edges))
        # The force of each pin on the cloth over the last dt [N].
        self.reactions = np.zeros_like(self.positions)
        self.report = Report(0, 0, True, np.zeros_like(self.free))
        self._make = ImplicitStep(
            self.law, self.free.ravel(), self.masses.ravel(), passes or passes_of(scene),
            self.bending)
        self._asked = np.zeros_like(self.positions)
        # Length of the last substep [s]; 0 before the first.
        self._before = 0.0

    def move_pin(self, row: int, col: int, velocity: np.ndarray) -> None:
        """Let the pinned node (row, col) move with ``velocity`` [m/s] from now on."""
        self._asked[row, col] = velocity

    def energies(self) -> Energies:
        """Return the energies of the present state; the elastic one is that of the law."""
        return Energies(
            kinetic_energy(self.velocities, self.free, self.masses),
            self.law.energy(self.law.edges.lengths(self.positions.reshape(-1, 3)))
            + self.bending.energy(self.positions),
            gravitational_energy(self.positions, self.masses, self.gravity))

    def excess(self) -> float:
        """Return how far the worst edge is past its limits, in rest lengths."""
        lengths = self.law.edges.lengths(self.positions.reshape(-1, 3))
        return float(np.max(self.law.excess(lengths), initial=0.0))

    def _step_of_dt(self) -> None:
        substeps = self._choose_substeps()
        h, solves, settled = self.dt / substeps, 0, True
        stopped = np.zeros_like(self.free)
        given = np.zeros_like(self.positions)
        for substep in range(substeps):
            step, held, tries = self._hold(self.steps * self.dt + substep * h, h)
            solves += tries
            settled &= step.settled
            given += self._pin_impulse(step, held, h)
            stopped |= held
            self.positions = step.positions.reshape(self.positions.shape)
            self.velocities = step.velocities.reshape(self.positions.shape)
            self.tension = step.tension
            self._before = h
        self.reactions = given / self.dt
        self.report = Report(substeps, solves, settled, stopped)

    def _choose_substeps(self) -> int:
        if not self.scene['auto_substeps']:
            return self.scene['substeps']
        foreseen = np.where(self.free[..., None], self._foreseen_velocities(), self._asked)
        longest = turn_substep(
            self.law.edges, self.positions.reshape(-1, 3), foreseen.reshape(-1, 3))
        wanted = max(math.ceil(self.dt / longest - _SUBSTEP_ROUNDING), 1)
        return min(self.scene['refine'] * wanted, self.scene['constraint.max_substeps'])

    def _hold(self, now: float, h: float) -> tuple[Step, np.ndarray, int]:
        """Return a substep, the pins that stand still in it, and the solves it took."""
        # A velocity belongs to the middle of its substep: gravity acts from the middle of the one
        # before. A push keeps its impulse.
        share = 0.5 * ((self._before or h) + h) / h
        bending = self.free[..., None] * self.bending.forces(self.positions)
        applied = share * (
            self.gravity * self.free[..., None] + self._air_accelerations(now, now + h)
            + bending * self._over_mass) + self._push_accelerations(now, now + h)
        damping = self.bending.damping_matrix(self.positions)
        held, solves = np.zeros_like(self.free), 0
        while True:
            start = self._start(held)
            damped = applied.reshape(-1, 3)
            if damping is not None:
                pulls = (damping @ start.ravel()).reshape(-1, 3)
                damped = damped - self.inverse_masses[:, None] * pulls
            step = self._make(
                self.positions.reshape(-1, 3), start.reshape(-1, 3), damped,
                self.tension if self._before else None, h, damping)
            solves += step.solves
            pull = np.linalg.norm(self._pull(step), axis=-1) / h
            too_much = ~self.free & ~held & self._asked.any(axis=-1) & (pull > self.max_force)
            if not too_much.any():
                return step, held, solves
            held |= too_much

    def _start(self, held: np.ndarray) -> np.ndarray:
        """Return the velocities with those of the pins, 0 where they are ``held`` [m/s]."""
        pins = np.where(held[..., None], 0.0, self._asked)
        return np.where(self.free[..., None], self.velocities, pins)

    def _pull(self, step: Step) -> np.ndarray:
        """Return the impulses of the edges on each node in a step [N s], (rows, cols, 3)."""
        return -self.law.edges.scatter(
            step.impulse, self.scene.node_count).reshape(self.positions.shape)

    def _pin_impulse(self, step: Step, held: np.ndarray, h: float) -> np.ndarray:
        """Return the impulses of the pins: against edges and weight, and for acceleration."""
        masses = self.masses[..., None]
        sped_up = masses * (self._start(held) - self.velocities)
        return ~self.free[..., None] * (sped_up - self._pull(step) - h * masses * self.gravity)
