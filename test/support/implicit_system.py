# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One solve of the implicit step as a sparse float64 system: what the solver has to find."""

from dataclasses import dataclass

from cloth_sim_ros.reference.edges import spring_sets
from cloth_sim_ros.reference.edges import SpringSet
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

# By rows and columns from one end to the other: the place of an edge in the last axis of tensions,
# and that of its rest length in a law.
_PLACES = {
    (0, 1): (0, 0), (1, 0): (1, 1), (1, 1): (2, 2), (1, -1): (3, 2), (0, 2): (4, 3),
    (2, 0): (5, 4)}


@dataclass(frozen=True)
class Solve:
    """
    Which solve of a step it is; the default is the first one of a new cloth.

    :param kick: that what is applied acts for [s]; None takes the length of the step
    :param foresees_turn: whether lengths have what moving across directions adds to them
    :param found: tensions of the solve before [N], (rows, cols, 6) as in Snapshot; None where
        there was none, which takes those of the present lengths
    :param expected: change of velocity that tells which limits come into force (rows, cols, 3)
        [m/s], where none had pulled; None for none
    :param is_further: the nodes have moved, and the solve finds what ``found`` lacks of the law
    :param is_next: ``found`` was solved for: where a limit pulled, it gives the distance of an
        edge beyond the limit
    """

    kick: float | None = None
    foresees_turn: bool = False
    found: np.ndarray | None = None
    expected: np.ndarray | None = None
    is_further: bool = False
    is_next: bool = False


@dataclass(frozen=True)
class _Edges:
    """
    Edges of one kind with a free end. Arrays have an entry an edge; all is over the node mass.

    :param first: number of the node that an edge begins at
    :param second: that of its other end
    :param length: [m]
    :param direction: from the second to the first (edges, 3)
    :param tension: what the solve begins with [m/s2]
    :param missing: what of it is not in the velocities yet [m/s2]
    :param slope: d lambda / dv along the edge, h s + k_d [1/s]
    :param across: beta h^2 lambda+ / l
    """

    place: int
    first: np.ndarray
    second: np.ndarray
    length: np.ndarray
    direction: np.ndarray
    tension: np.ndarray
    missing: np.ndarray
    slope: np.ndarray
    across: np.ndarray


class ImplicitSystem:
    """
    (M + h J^T (h s + k_d) J + beta h^2 K_geo) dv = b, over the node mass.

    s is the slope of the law, K_geo the sum of (lambda+ / l) (I - n n^T) over the edges. The rows
    of pinned nodes are those of the identity.

    :param positions: (rows, cols, 3) [m]
    :param velocities: (rows, cols, 3) [m/s]
    :param acceleration: on every free node [m/s2], or (rows, cols, 3)
    """

    def __init__(
            self, scene: Scene, law: EdgeLaw, positions: np.ndarray, velocities: np.ndarray,
            acceleration: np.ndarray | tuple[float, float, float],
            solve: Solve = Solve()) -> None:
        """Add up all edges."""
        self._law = law
        self._node_mass = scene.node_mass
        self._shape = positions.shape
        free = ~scene.pinned_nodes()
        self._free = free.ravel()
        kick = law.length if solve.kick is None else solve.kick
        given = kick * self._free[:, None] * np.broadcast_to(
            np.asarray(acceleration, float), self._shape).reshape(-1, 3)
        x, v = (field.reshape(-1, 3).astype(float) for field in (positions, velocities))
        self._edges = [
            self._edges_of(springs, x, v, solve)
            for springs in spring_sets(scene, FAMILIES)]
        self._blocks, self._matrix = self._add_up()
        right = np.zeros_like(x) if solve.is_further else given
        for edges in self._edges:
            impulse = law.length * edges.missing[:, None] * edges.direction
            np.subtract.at(right, edges.first, impulse)
            np.add.at(right, edges.second, impulse)
        self.right_side = (self._free[:, None] * right).reshape(self._shape)

    def times(self, vector: np.ndarray) -> np.ndarray:
        """Multiply (rows, cols, 3) ``vector`` by the matrix."""
        return (self._matrix @ vector.astype(float).ravel()).reshape(self._shape)

    def solve(self, right_side: np.ndarray | None = None) -> np.ndarray:
        """Return the solution for ``right_side``, by default that of the step."""
        right = self.right_side if right_side is None else right_side
        factors = splu(
            self._matrix, permc_spec='MMD_AT_PLUS_A', diag_pivot_thresh=0.0,
            options={'SymmetricMode': True})
        return factors.solve(right.astype(float).ravel()).reshape(self._shape)

    def norm(self, vector: np.ndarray) -> float:
        """Return sqrt((u, A u)) of (rows, cols, 3) ``vector`` u and the matrix A."""
        return float(np.sqrt(np.sum(vector * self.times(vector))))

    def rounding(self) -> float:
        """Return the norm of what float32 rounds the right side by [m/s]."""
        # Length of each edge, and its tension by the law.
        square = sum(np.sum(2.0 * (
            edges.slope * edges.length + self._law.length * np.abs(edges.tension))**2)
            for edges in self._edges)
        return float(np.finfo(np.float32).eps * np.sqrt(square))

    def jacobi_norm(self, vector: np.ndarray) -> float:
        """Return sqrt((r, B r)) of ``vector`` r, B the inverse of the diagonal 3 x 3 blocks."""
        vectors = vector.reshape(-1, 3, 1).astype(float)
        return float(np.sqrt(np.sum(vectors * np.linalg.solve(self._blocks, vectors))))

    def tensions(self, change: np.ndarray) -> np.ndarray:
        """Return what each edge pulls with [N] when ``change`` is dv, (rows, cols, 6)."""
        tensions = np.zeros((len(self._free), len(_PLACES)))
        flat = change.reshape(-1, 3).astype(float)
        for edges in self._edges:
            growth = _along(edges.direction, flat[edges.first] - flat[edges.second])
            tensions[edges.first, edges.place] = edges.tension + edges.slope * growth
        return self._node_mass * tensions.reshape(*self._shape[:2], -1)

    def _edges_of(
            self, springs: SpringSet, x: np.ndarray, v: np.ndarray,
            solve: Solve) -> _Edges:
        h = self._law.length
        place, rest = _PLACES[springs.down, springs.right]
        numbers = np.arange(len(x)).reshape(self._shape[:2])
        first, second = (end.ravel() for end in springs.ends(numbers))
        moves = self._free[first] | self._free[second]
        first, second = first[moves], second[moves]
        apart, rates = x[first] - x[second], v[first] - v[second]
        length = np.linalg.norm(apart, axis=1)
        direction = apart / length[:, None]
        rate = _along(direction, rates)
        kind = FAMILIES.index(springs.family), rest, springs.rest_length
        at = judged = length
        if not solve.is_further:
            expected = np.zeros_like(rates)
            if solve.expected is not None:
                flat = solve.expected.reshape(-1, 3).astype(float)
                expected = flat[first] - flat[second]
            at = length + h * rate
            if solve.foresees_turn:
                sideways = h * (rates - rate[:, None] * direction)
                at = at + np.sqrt(length**2 + np.sum(sideways**2, axis=1)) - length
            judged = at + h * _along(direction, expected)
        if solve.found is None:
            before, _ = self._pull(length, length, 0.0 * rate, *kind)
        else:
            before = solve.found.reshape(len(x), -1)[first, place] / self._node_mass
        if solve.is_next:
            judged = self._length_of(before, rate, judged, *kind)
        tension, slope = self._pull(at, judged, rate, *kind)
        return _Edges(
            place, first, second, length, direction, tension,
            tension - before if solve.is_further else tension,
            h * slope + self._law.damping[kind[1]],
            self._law.geometric * h**2 * np.maximum(before, 0.0) / length)

    def _length_of(
            self, tension: np.ndarray, rate: np.ndarray, otherwise: np.ndarray, family: int,
            rest: int, rest_length: float) -> np.ndarray:
        """
        Return how long edges of ``tension`` [m/s2] are beyond a limit [m], ``otherwise`` if not.

        The spring counts as long as where the limit begins to pull.
        """
        law = self._law
        width = law.transition * rest_length
        judged = otherwise.copy()
        for sign, limit in ((1.0, law.longest[family]), (-1.0, law.shortest[family])):
            begin = limit * rest_length - sign * width
            past = sign * (
                tension - law.damping[rest] * rate
                - law.stiffness[rest] * (begin - rest_length)) / law.limit_stiffness[rest]
            pulls = (past > 0.0) & (0.0 < limit < 1e20)
            into = np.minimum(np.sqrt(np.maximum(past, 0.0) / width), 1.0) if width else 1.0
            beyond = into * 2.0 * width + np.maximum(past - width, 0.0)
            judged[pulls] = (begin + sign * beyond)[pulls]
        return judged

    def _pull(
            self, length: np.ndarray, judged: np.ndarray, rate: np.ndarray, family: int,
            rest: int, rest_length: float) -> tuple[np.ndarray, np.ndarray]:
        """
        Return lambda(l) over the node mass [m/s2], and d lambda / dl [1/s2].

        :param judged: length that tells which limit is in force [m]
        """
        law = self._law
        shortest, longest = (
            limits[family] * rest_length for limits in (law.shortest, law.longest))
        if shortest == longest:
            slope, past = np.ones_like(length), length - longest
        else:
            # There is no lower limit at 0: where an edge turns over within the step, its length
            # along n comes out below.
            sides = [(1.0, judged - longest)]
            if shortest > 0.0:
                sides.append((-1.0, shortest - judged))
            slope, past = np.zeros_like(length), np.zeros_like(length)
            width = law.transition * rest_length
            for sign, beyond in sides:
                into = np.clip((beyond + width) / (2.0 * width), 0.0, 1.0) if width else (
                    1.0 * (beyond > 0.0))
                past += sign * (width * into**2 + np.maximum(beyond - width, 0.0))
                slope += into
            past += slope * (length - judged)
        limit = law.limit_stiffness[rest]
        tension = (
            law.stiffness[rest] * (length - rest_length) + law.damping[rest] * rate
            + limit * past)
        return tension, law.stiffness[rest] + limit * slope

    def _add_up(self) -> tuple[np.ndarray, csc_matrix]:
        """Return the diagonal blocks (nodes, 3, 3) and the matrix."""
        count = len(self._free)
        diagonal = np.broadcast_to(np.eye(3), (count, 3, 3)).copy()
        nodes = np.arange(count)
        rows, columns, blocks = [nodes], [nodes], [diagonal]
        for edges in self._edges:
            outer = edges.direction[:, :, None] * edges.direction[:, None, :]
            along, across = self._law.length * edges.slope, edges.across
            block = (
                along[:, None, None] * outer + across[:, None, None] * (np.eye(3) - outer))
            for one, other in ((edges.first, edges.second), (edges.second, edges.first)):
                free = self._free[one]
                np.add.at(diagonal, one[free], block[free])
                free = free & self._free[other]
                rows.append(one[free])
                columns.append(other[free])
                blocks.append(-block[free])
        row = 3 * np.concatenate(rows)[:, None, None] + np.arange(3)[:, None]
        column = 3 * np.concatenate(columns)[:, None, None] + np.arange(3)
        row, column = np.broadcast_arrays(row, column)
        matrix = coo_matrix(
            (np.concatenate(blocks).ravel(), (row.ravel(), column.ravel())),
            shape=(3 * count, 3 * count))
        return diagonal, matrix.tocsc()


def _along(direction: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    return np.sum(direction * vectors, axis=1)


def relative_error(values: np.ndarray, expected: np.ndarray) -> float:
    """Return the norm of the difference over that of ``expected``."""
    return float(np.linalg.norm(values - expected) / np.linalg.norm(expected))
