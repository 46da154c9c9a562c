# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Springs stepped by symplectic Euler, then held within their strain limits exactly."""

from dataclasses import dataclass
import math

from cloth_sim_ros.reference.edge_law import limit_compliance
from cloth_sim_ros.reference.edge_law import LIMITED
from cloth_sim_ros.reference.edge_law import strain_past_limit
from cloth_sim_ros.reference.edges import Edges
from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
import numpy as np
from scipy import sparse

# Fraction of the excess of an edge beyond its limit that a substep takes away [1]: part of the
# scheme, as in sim/limits/limit_program.py.
CLOSING = 0.1
# Max. change of a length by the last round, over the rest length [1]; float64 rounds by 1e-16.
_EXACT = 1e-13
# Max. rounds [1]: a cloth of 6 x 5 nodes takes some hundreds to some thousands.
_MOST_ROUNDS = 20_000


@dataclass(frozen=True)
class Projection:
    """
    What limits do to the velocities of a substep.

    :param velocities: after it, (nodes, 3) [m/s]
    :param impulses: that pull the first node of each edge to the second, (edges, 3) [N s]; they
        may be one choice of many where edges are redundant
    :param rounds: that it took
    """

    velocities: np.ndarray
    impulses: np.ndarray
    rounds: int


class LimitProjection:
    """
    The velocities nearest to given ones, in the metric of the masses, that keep all limits.

    At the end of a substep of length h an edge d = x1 - x2 has become d + h (u1 - u2). Its length
    must be l_max at most, and its part along d must be l_min at least. An edge that begins beyond
    a limit may keep 1 - CLOSING of its excess. Pins keep their velocities.

    A limit gives way: an impulse J lets its edge pass that length by CLOSING E J / h. So an edge
    at rest that is pulled with the force F stays E F beyond its limit, at any h.

    The dual is solved: one impulse for each edge and limit, by accelerated proximal gradient steps
    that restart where they overshoot.

    :param edges: all of them have both limits
    :param inverse_masses: of the nodes, 0 for pins [1/kg]
    :param limit: of |l / L0 - 1|
    :param compliance: E of each edge [m/N]; 0 for limits that do not give way
    """

    def __init__(
            self, edges: Edges, inverse_masses: np.ndarray, limit: float,
            compliance: np.ndarray | float = 0.0) -> None:
        """Set up how edges pull at nodes."""
        self._weights = inverse_masses[:, None]
        self._rest = edges.rest_length
        self._limit = limit
        count, nodes = len(edges), len(inverse_masses)
        self._compliance = np.tile(np.broadcast_to(compliance, count), 2)[:, None]
        numbers = np.tile(np.arange(count), 2)
        one_each = sparse.csr_matrix((
            np.repeat((1.0, -1.0), count),
            (numbers, np.concatenate((edges.first, edges.second)))), (count, nodes))
        # The upper limits, then the lower ones.
        self._differences = sparse.vstack((one_each, one_each)).tocsr()
        self._scatter = self._differences.T.tocsr()
        # Bounds the largest eigenvalue of the dual: each node has so many limits.
        crowd = np.bincount(self._differences.indices, minlength=nodes) * inverse_masses
        self._per_impulse = np.tile(crowd[edges.first] + crowd[edges.second], 2)[:, None]

    def __call__(
            self, positions: np.ndarray, velocities: np.ndarray, h: float,
            first_guess: np.ndarray | None = None) -> Projection:
        """
        Return the projection.

        :param positions: at the start of the substep, (nodes, 3) [m]
        :param velocities: without limits, (nodes, 3) [m/s]
        :param h: length of the substep [s]
        :param first_guess: impulses of an earlier one [N s]
        :raises ClothSimError: when the limits cannot all be kept, as between two pins
        """
        count = len(self._rest)
        d = (self._differences @ positions)[:count]
        lengths = np.linalg.norm(d, axis=1)
        longest = _closed_in(lengths, self._rest * (1.0 + self._limit), 1.0)
        shortest = _closed_in(lengths, self._rest * (1.0 - self._limit), -1.0)
        # An edge without a length has no lower limit: there is no direction to push it in.
        along = np.divide(
            d, lengths[:, None], out=np.zeros_like(d), where=lengths[:, None] > 0.0)
        scale = h * self._per_impulse
        is_free = scale[:, 0] > 0.0
        scale = np.where(is_free[:, None], scale, 1.0)
        divisor = scale + CLOSING / h * self._compliance
        doubled = np.vstack((d, d))
        last = np.zeros_like(doubled)
        if first_guess is not None:
            outward = np.sum(first_guess * along, axis=1, keepdims=True) < 0.0
            last = np.vstack((
                np.where(outward, 0.0, first_guess), np.where(outward, first_guess, 0.0)))
        y, momentum = last, 1.0
        for rounds in range(1, _MOST_ROUNDS + 1):
            moved = velocities - self._weights * (self._scatter @ y)
            q = doubled + h * (self._differences @ moved) + scale * y
            upper = np.linalg.norm(q[:count], axis=1)
            past = np.maximum(upper - longest, 0.0) / np.maximum(upper, 1e-300)
            short = np.minimum(np.sum(along * q[count:], axis=1) - shortest, 0.0)
            z = np.vstack((past[:, None] * q[:count], short[:, None] * along)) / divisor
            z[~is_free] = 0.0
            steps = np.linalg.norm(scale * (z - y), axis=1).reshape(2, count)
            change = np.max(steps / self._rest, initial=0.0)
            if change <= _EXACT:
                impulses = z[:count] + z[count:]
                moved = velocities - self._weights * (self._scatter @ z)
                return Projection(moved, impulses, rounds)
            if np.sum(self._per_impulse * (y - z) * (z - last)) > 0.0:
                momentum = 1.0
            following = 0.5 * (1.0 + math.sqrt(1.0 + 4.0 * momentum**2))
            y = z + (momentum - 1.0) / following * (z - last)
            last, momentum = z, following
        raise ClothSimError(
            'limits must be such that all can be kept, got edges that still changed by '
            f'{change:g} of their length after {_MOST_ROUNDS} rounds: move pins more slowly or '
            'raise the limit')


def _closed_in(lengths: np.ndarray, bound: np.ndarray, side: float) -> np.ndarray:
    """Return the ``bound`` of a length [m], or the length less CLOSING of its excess."""
    return bound + side * (1.0 - CLOSING) * np.maximum(side * (lengths - bound), 0.0)


class LimitedSpringsReference(MassSpringReference):
    """
    What mode adaptive does in its schemes list and lattice, without their tolerances.

    Each substep is one of MassSpringReference, whose velocities are then changed by the limits of
    all structural and shear edges, before the nodes move by them.

    :param scene: what is modelled; its timed pushes act at their times
    :param substeps: substeps in each dt; the scene's own choice when not given
    """

    def __init__(self, scene: Scene, substeps: int | None = None) -> None:
        """Start at rest in the scene's start pose."""
        super().__init__(scene, substeps)
        self.limited = self._edges.only(LIMITED)
        self._project = LimitProjection(
            self.limited, self.inverse_masses, scene['adaptive.threshold'],
            limit_compliance(scene, self.limited, strain_past_limit(scene)))
        # Impulses of the limits in the last substep [N s], (edges, 3).
        self.impulses = np.zeros((len(self.limited), 3))
        # Mean force of each pin on the cloth over the last dt [N], (rows, cols, 3).
        self.reactions = np.zeros_like(self.positions)
        # Largest rise of the kinetic energy by the limits in a substep so far [J].
        self.largest_rise = -math.inf
        self._given = np.zeros_like(self.positions)

    def strains_over_limit(self) -> np.ndarray:
        """Return |l / L0 - 1| of each limited edge over its limit."""
        strains = self.limited.strains(self.positions.reshape(-1, 3))
        return np.abs(strains) / self.scene['adaptive.threshold']

    def _step_of_dt(self) -> None:
        self._given[:] = 0.0
        super()._step_of_dt()
        self.reactions = self._given / self.dt

    def _substep(self, begin: float, end: float) -> None:
        h, masses = end - begin, self.masses[..., None]
        start, shape = self.positions.copy(), self.positions.shape
        springs = self._edges.spring_forces(
            start.reshape(-1, 3), self.velocities.reshape(-1, 3)).reshape(shape)
        bending = self.bending.forces(start) + self.bending.damping_forces(
            start, self.velocities)
        super()._substep(begin, end)
        found = self._project(
            start.reshape(-1, 3), self.velocities.reshape(-1, 3), h, self.impulses)
        after = found.velocities.reshape(shape)
        rise = self.free[..., None] * masses * (after**2 - self.velocities**2)
        self.largest_rise = max(self.largest_rise, 0.5 * float(np.sum(rise)))
        self.impulses = found.impulses
        self.velocities = after
        self.positions = start + h * after
        pulls = -self.limited.scatter(found.impulses, self.scene.node_count).reshape(shape)
        held = ~self.free[..., None]
        self._given -= held * (pulls + h * (springs + bending + masses * self.gravity))
