# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
One implicit step of a cloth whose edges follow an ``EdgeLaw``.

A pass finds the change of the velocities dv that meets

    (M + beta h^2 (K_geo + K_bend)) dv + h J^T lambda(l + h J dv, ...) = h F
    K_geo = sum over edges of (lambda+ / l) (I - n n^T)

with the directions n in J and K_geo frozen, and bending as at the start of the step in F. It is
the minimum of a convex function, and Newton's method with a line search finds it. First come
``start`` passes with the directions that edges have at the start of the step, then ``end`` passes
with those that they have come to. docs/explanation/implicit_step.md derives it.
"""

from dataclasses import dataclass

from cloth_sim_ros.reference.edge_law import EdgeLaw
from cloth_sim_ros.reference.edges import Edges
from cloth_sim_ros.reference.forces import Bending
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
import numpy as np
from scipy import sparse
from scipy.optimize import brentq
from scipy.sparse.linalg import splu

# Below this many unknowns a dense solve is the quicker one.
DENSE = 60


class EdgeMatrix:
    """
    M plus, for each edge, a block K that resists what its ends move past one another.

    :param edges: between nodes
    :param free: which nodes can move, bool (nodes,)
    :param masses: of the nodes, (nodes,) [kg]
    :param bending: what it resists, (nodes, nodes), which counts the same in x, y and z
    """

    def __init__(
            self, edges: Edges, free: np.ndarray, masses: np.ndarray,
            bending: sparse.spmatrix | None = None) -> None:
        """Find where each number of each block goes; only free nodes have unknowns."""
        self.free = free
        self._own = np.repeat(free, 3)
        self.size = 3 * int(np.count_nonzero(free))
        number = np.cumsum(free) - 1
        rows, cols, self._parts = [np.arange(self.size)], [np.arange(self.size)], []
        self._masses = np.repeat(masses[free], 3)
        for one, other, sign in (
                (edges.first, edges.first, 1.0), (edges.second, edges.second, 1.0),
                (edges.first, edges.second, -1.0), (edges.second, edges.first, -1.0)):
            used = np.flatnonzero(free[one] & free[other])
            row = 3 * number[one[used]][:, None, None] + np.arange(3)[:, None]
            col = 3 * number[other[used]][:, None, None] + np.arange(3)
            row, col = np.broadcast_arrays(row, col)
            rows.append(row.ravel())
            cols.append(col.ravel())
            self._parts.append((used, sign))
        tied = sparse.coo_matrix((0, 0)) if bending is None else (
            bending.tocsr()[free][:, free].tocoo())
        for axis in range(3):
            rows.append(3 * tied.row.astype(int) + axis)
            cols.append(3 * tied.col.astype(int) + axis)
        self._bending = np.tile(tied.data, 3)
        # Column by column, as the solver wants them; several numbers share a place.
        places, self._place = np.unique(
            np.concatenate(cols) * self.size + np.concatenate(rows), return_inverse=True)
        self._flat = places
        self._indices = places % max(self.size, 1)
        self._starts = np.searchsorted(places // max(self.size, 1), np.arange(self.size + 1))

    def solve(
            self, blocks: np.ndarray, right: np.ndarray, share: float = 0.0,
            more: sparse.csr_matrix | None = None) -> np.ndarray:
        """
        Return what solves (M + K + K_bend + ``more``) dv = ``right``, 0 where it is not free.

        :param blocks: K of each edge, symmetric, (edges, 3, 3) [kg]
        :param right: (nodes, 3) [kg m/s]
        :param share: of the matrix of bending in K_bend [s2]
        :param more: (3 nodes, 3 nodes) [kg]; None for none
        :return: dv (nodes, 3) [m/s]
        """
        change = np.zeros_like(right)
        if not self.size:
            return change
        numbers = np.concatenate(
            [self._masses, *(sign * blocks[used].ravel() for used, sign in self._parts),
             share * self._bending])
        data = np.bincount(self._place, numbers, len(self._flat))
        if self.size <= DENSE:
            dense = np.zeros((self.size, self.size))
            dense.ravel()[self._flat] = data
            if more is not None:
                dense += more[self._own][:, self._own].toarray()
            found = np.linalg.solve(dense, right[self.free].ravel())
        else:
            matrix = sparse.csc_matrix(
                (data, self._indices, self._starts), shape=(self.size, self.size))
            if more is not None:
                matrix = (matrix + more[self._own][:, self._own]).tocsc()
            found = splu(
                matrix, permc_spec='MMD_AT_PLUS_A', diag_pivot_thresh=0.0,
                options={'SymmetricMode': True}).solve(right[self.free].ravel())
        change[self.free] = found.reshape(-1, 3)
        return change


# Weight of the bending matrix in the system, over h^2 [1]. With the force at the start of the step
# it gives the force at the midpoint, which is stable at any h and conserves energy.
_BENDING = 0.5


# Newton's method ends when the energy of its step is below this fraction of the kinetic energy of
# the solution [1].
_CONVERGED = 1e-22


@dataclass(frozen=True)
class Passes:
    """
    How a step is solved.

    :param start: passes along the edges as they are at the start of the step, 1 or more; they
        find the limits that are in force
    :param end: passes along the edges as they are at its end; they take away what lengths are off
    :param foresees_turn: let the start passes predict the rotation of edges
    :param beta: share of K_geo in the matrix; 0 leaves it out, and large steps then blow up
    :param solves: the most linear solves of one pass, which ends when nothing is missing
    """

    start: int = 1
    end: int = 1
    foresees_turn: bool = True
    beta: float = 0.5
    solves: int = 40

    def __post_init__(self) -> None:
        """Refuse invalid options."""
        for name, least in (('start', 1), ('end', 0), ('solves', 1), ('beta', 0.0)):
            if not getattr(self, name) >= least:
                raise ClothSimError(
                    f'{name} of the passes must be {least} or more, got {getattr(self, name)}: '
                    'raise it')


def passes_of(scene: Scene) -> Passes:
    """Return the passes of mode constraint: a single one is the plain step of the paper."""
    solves = scene['constraint.newton_iterations']
    if solves == 1:
        return Passes(end=0, foresees_turn=False, beta=0.0)
    return Passes(end=solves - 1)


@dataclass(frozen=True)
class Step:
    """
    The result of a step.

    :param positions: at its end (nodes, 3) [m]
    :param velocities: (nodes, 3) [m/s]
    :param tension: lambda of each edge [N]; 0 between two nodes that cannot move
    :param impulse: of each edge on its second end; the first gets its opposite (edges, 3) [N s]
    :param settled: whether the limits in force were found in each pass; momentum is kept only then
    :param solves: linear solves that were made
    """

    positions: np.ndarray
    velocities: np.ndarray
    tension: np.ndarray
    impulse: np.ndarray
    settled: bool
    solves: int


@dataclass(frozen=True)
class _Pass:
    """
    Constants of a pass: the lengths without dv, and loads other than the edges.

    :param directions: n (edges, 3)
    :param lengths: [m]
    :param rates: [m/s]
    :param across: beta h^2 lambda+ / l of each edge [kg]
    :param held: the tension that is already in the velocities [N]
    :param driven: velocities that what is applied adds (nodes, 3) [m/s]
    :param h: length of the step [s]
    :param damping: what damping of bending resists (3 nodes, 3 nodes) [N s/m]; None for none
    """

    directions: np.ndarray
    lengths: np.ndarray
    rates: np.ndarray
    across: np.ndarray
    held: np.ndarray
    driven: np.ndarray
    h: float
    damping: sparse.csr_matrix | None = None


class ImplicitStep:
    """
    The step of one cloth; it holds no state.

    :param law: of the edges
    :param free: which nodes can move, bool (nodes,); the others keep their velocity
    :param masses: of the nodes, (nodes,) [kg]
    :param bending: of the cloth, if it resists
    """

    def __init__(
            self, law: EdgeLaw, free: np.ndarray, masses: np.ndarray, passes: Passes,
            bending: Bending | None = None) -> None:
        """Lay out the matrix."""
        self.law = law
        self.passes = passes
        self._masses = masses[:, None]
        self._free = free[:, None]
        self._moves = free[law.edges.first] | free[law.edges.second]
        self._bending = (
            sparse.csr_matrix((len(free), len(free))) if bending is None else bending.matrix)
        self._matrix = EdgeMatrix(law.edges, free, masses, self._bending)

    def __call__(
            self, positions: np.ndarray, velocities: np.ndarray, applied: np.ndarray,
            before: np.ndarray | None, h: float,
            damping: sparse.csr_matrix | None = None) -> Step:
        """
        Return the state after a step of ``h`` [s].

        :param positions: (nodes, 3) [m]
        :param velocities: (nodes, 3) [m/s]
        :param applied: accelerations by gravity and pushes (nodes, 3) [m/s2]
        :param before: tensions at the end of the step before, for the first K_geo [N]; None where
            there was none, so that those of the present lengths count
        :param damping: what damping of bending resists in it, (3 nodes, 3 nodes) [N s/m]
        """
        edges = self.law.edges
        lengths, directions = edges.lengths(positions), edges.directions(positions)
        driven = h * applied * self._free
        rates = edges.along(velocities, directions)
        if before is None:
            before = self._moves * self.law.tension(lengths, np.zeros_like(lengths))
        change, tension, solves = np.zeros_like(positions), before, 0
        settled = True
        ahead = velocities
        for _ in range(self.passes.start):
            one = _Pass(
                directions, lengths + h * rates + self._turn(ahead, directions, lengths, h), rates,
                self._across(tension, lengths, h), np.zeros_like(lengths), driven, h,
                damping)
            change, tension, found, count = self._settle(one, change)
            solves += count
            settled &= found
            ahead = velocities + change
        impulse = self._impulse(one, change, tension)
        for _ in range(self.passes.end):
            velocity = velocities + change
            at = positions + h * velocity
            lengths, directions = edges.lengths(at), edges.directions(at)
            one = _Pass(
                directions, lengths, edges.along(velocity, directions),
                self._across(tension, lengths, h), tension, np.zeros_like(at), h,
                damping)
            added, tension, found, count = self._settle(one, np.zeros_like(at))
            solves += count
            settled &= found
            change = change + added
            impulse = impulse + self._impulse(one, added, tension)
        velocities = velocities + change
        return Step(
            positions + h * velocities, velocities, tension, impulse, settled, solves)

    def _turn(
            self, ahead: np.ndarray, directions: np.ndarray, lengths: np.ndarray,
            h: float) -> np.ndarray:
        """Return how much longer each edge gets by turning, in second order of h [m]."""
        if not self.passes.foresees_turn:
            return np.zeros_like(lengths)
        turned = h * self.law.edges.across(ahead, directions)
        return np.sqrt(lengths**2 + np.sum(turned**2, axis=1)) - lengths

    def _settle(
            self, one: _Pass, change: np.ndarray) -> tuple[np.ndarray, np.ndarray, bool, int]:
        """Return dv, the tensions, whether the limits in force were found, and the solves."""
        law, h, edges = self.law, one.h, self.law.edges
        for count in range(1, self.passes.solves + 1):
            grown = edges.along(change, one.directions)
            slopes = law.slope(one.lengths + h * grown)
            right = self._right(one, change)
            slope = h * (h * slopes + law.damping)
            outer = one.directions[:, :, None] * one.directions[:, None, :]
            added = self._matrix.solve(
                slope[:, None, None] * outer
                + one.across[:, None, None] * (np.eye(3) - outer), right,
                _BENDING * h**2, None if one.damping is None else h * one.damping)
            lengths = one.lengths + h * edges.along(change + added, one.directions)
            is_straight = np.array_equal(law.slope(lengths), slopes)
            if is_straight or self._is_nothing(one, change, added, right):
                # Along a straight law Newton's step goes to the minimum of a parabola.
                change = change + added
                return change, self._law(one, change), True, count
            change = change + self._share(one, change, added) * added
        return change, self._law(one, change), False, count

    def _is_nothing(
            self, one: _Pass, change: np.ndarray, added: np.ndarray, right: np.ndarray) -> bool:
        """Return whether Newton's step gains no more than float64 resolves."""
        pull = one.h * self._law(one, change + added)
        scale = float(np.sum(self._masses * (one.driven**2 + change**2))) + (
            float(np.sum(pull**2)) / float(self._masses.max()))
        return float(np.sum(right * added)) <= _CONVERGED * scale

    def _share(self, one: _Pass, change: np.ndarray, added: np.ndarray) -> float:
        """Return which share of ``added`` to take: up to the minimum along it, 1 at most."""
        def down(share: float) -> float:
            return float(np.sum(self._right(one, change + share * added) * added))

        return 1.0 if down(1.0) >= 0.0 else brentq(down, 0.0, 1.0, xtol=1e-3)

    def _right(self, one: _Pass, change: np.ndarray) -> np.ndarray:
        """Return the missing momentum of each free node [kg m/s]."""
        tension = self._law(one, change)
        return self._free * (
            self._masses * (one.driven - change)
            - _BENDING * one.h**2 * (self._bending @ change)
            - (0.0 if one.damping is None
               else one.h * (one.damping @ change.ravel()).reshape(change.shape))
            - self.law.edges.scatter(self._impulse(one, change, tension), len(change)))

    def _impulse(self, one: _Pass, change: np.ndarray, tension: np.ndarray) -> np.ndarray:
        return (one.h * (tension - one.held)[:, None] * one.directions
                + one.across[:, None] * self.law.edges.across(change, one.directions))

    def _law(self, one: _Pass, change: np.ndarray) -> np.ndarray:
        grown = self.law.edges.along(change, one.directions)
        lengths = one.lengths + one.h * grown
        return self._moves * self.law.tension(lengths, one.rates + grown)

    def _across(self, tension: np.ndarray, lengths: np.ndarray, h: float) -> np.ndarray:
        """Return beta h^2 lambda+ / l [kg]; 0 for an edge without length."""
        pull = self.passes.beta * h**2 * np.maximum(tension, 0.0)
        return np.divide(pull, lengths, out=np.zeros_like(pull), where=lengths > 0.0)
