# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the serial program of the paper steps, and that program in NumPy, in float64."""

from collections.abc import Sequence
from dataclasses import dataclass
from dataclasses import replace

from cloth_sim_ros.reference.edge_law import limit_compliance
from cloth_sim_ros.reference.edge_law import LIMITED
from cloth_sim_ros.reference.edges import Edges
from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
import numpy as np
from scipy import sparse

# As that of study/timed_solvers.py: the paper names none.
TOLERANCE = 1e-2
MOST_ITERATIONS = 2000
# D of the adaptive scheme over the sum of inverse masses, as in paper/sweep.comp.
_DELTA = 1e-3
_ALWAYS = -1.0


@dataclass(frozen=True)
class SerialModel:
    """
    One cloth as the serial program has it; a step of h is a frame.

    v += h (g + F / m), then (J W J^T + D) lambda = Phi / h^2 + J v / h for the constraints,
    v -= h W J^T lambda, x += h v: sections 4.1 to 4.3 of the paper.

    :param edges: springs, and what can be a constraint
    :param inverse_masses: of each node [1/kg], 0 where it is pinned
    :param limited: which edges can be constraints, bool; None where none can
    :param diagonal: D of each edge [1/kg]
    :param threshold: |l / L0 - 1| beyond which an edge is a constraint; below 0 it is one always
    :param step: h [s]
    :param forms_matrix: form J W J^T pair by pair, as the paper does, or never
    :param tolerance: of conjugate gradients: norm of the residual over that at the start
    """

    edges: Edges
    inverse_masses: np.ndarray
    gravity: np.ndarray
    step: float
    limited: np.ndarray | None = None
    diagonal: np.ndarray | None = None
    threshold: float = _ALWAYS
    forms_matrix: bool = False
    tolerance: float = TOLERANCE
    most_iterations: int = MOST_ITERATIONS

    @property
    def is_hard(self) -> bool:
        """Return whether edges are constraints at any length."""
        return self.threshold < 0.0

    def with_matrix(self) -> 'SerialModel':
        """Return the same cloth, whose matrix is formed pair by pair."""
        return replace(self, forms_matrix=True)


def serial_model(scene: Scene, *, tolerance: float = TOLERANCE) -> SerialModel:
    """
    Return what the serial program steps in the mode of ``scene``.

    Constraint: hard edges, one solve a step, without other edges. Adaptive: the paper's scheme.
    """
    step = scene['dt'] / (1 if scene['auto_substeps'] else scene['substeps'])
    inverse_masses = ~scene.pinned_nodes().ravel() / (
        scene.node_mass * scene.node_shares.ravel())
    gravity = np.array(scene['gravity'], float)
    if scene['mode'] == 'mass_spring':
        return SerialModel(edges_of(scene), inverse_masses, gravity, step)
    hard: Sequence[str] = scene['constraint.hard'] if scene['mode'] == 'constraint' else ()
    edges = edges_of(scene, always=hard)
    sums = inverse_masses[edges.first] + inverse_masses[edges.second]
    # An edge between two pins would make an empty row.
    kept = (sums > 0.0) & edges.of(hard or FAMILIES)
    edges, sums = edges.where(kept), sums[kept]
    if hard:
        return SerialModel(
            edges, inverse_masses, gravity, step, np.ones(len(edges), bool),
            limit_compliance(scene, edges) / step**2, tolerance=tolerance)
    return SerialModel(
        edges, inverse_masses, gravity, step, edges.of(LIMITED), _DELTA * sums,
        scene['adaptive.threshold'], tolerance=tolerance)


class NumpyCloth:
    """
    The serial program in NumPy, where there is no C compiler; it forms no matrix pair by pair.

    :param model: what is stepped
    :param positions: (rows, cols, 3) [m]
    :param velocities: (rows, cols, 3) [m/s]
    """

    name = 'NumPy, float64'

    def __init__(
            self, model: SerialModel, positions: np.ndarray, velocities: np.ndarray) -> None:
        """Copy the state."""
        self._model = model
        self.iterations = 0
        self.held = 0
        self.set_state(positions, velocities)

    def set_state(self, positions: np.ndarray, velocities: np.ndarray) -> None:
        """Replace positions [m] and velocities [m/s], (rows, cols, 3)."""
        self.positions, self.velocities = positions.astype(float), velocities.astype(float)

    def step(self) -> None:
        """Make one step of h."""
        model, edges, h = self._model, self._model.edges, self._model.step
        x, v = self.positions.reshape(-1, 3), self.velocities.reshape(-1, 3)
        weights = model.inverse_masses[:, None]
        directions, lengths = edges.directions(x), edges.lengths(x)
        held = np.zeros(len(edges), bool) if model.limited is None else (
            model.limited & (np.abs(lengths - edges.rest_length)
                             > model.threshold * edges.rest_length))
        tension = ~held * (
            edges.stiffness * (lengths - edges.rest_length)
            + edges.damping * edges.along(v, directions))
        force = -edges.scatter(tension[:, None] * directions, len(x))
        v += h * ((weights > 0.0) * model.gravity + weights * force)
        self.held, self.iterations = int(np.count_nonzero(held)), 0
        if self.held:
            self._constrain(edges.where(held), held, directions[held], lengths[held], v)
        x += h * v

    def finish(self) -> None:
        """Do nothing: a step ends when it returns."""

    def close(self) -> None:
        """Do nothing: there is nothing on a device."""

    def _constrain(
            self, edges: Edges, held: np.ndarray, directions: np.ndarray, lengths: np.ndarray,
            v: np.ndarray) -> None:
        model, rest = self._model, edges.rest_length
        assert model.diagonal is not None  # it has constraints
        off = lengths - rest if model.is_hard else (lengths**2 - rest**2) / (2.0 * lengths)
        jacobian = edges.jacobian(directions, len(v))
        weights = np.repeat(model.inverse_masses, 3)
        matrix = jacobian @ sparse.diags(weights) @ jacobian.T + sparse.diags(model.diagonal[held])
        right = off / model.step**2 + jacobian @ v.ravel() / model.step
        tensions, self.iterations = conjugate_gradients(
            matrix.tocsr(), right, model.tolerance, model.most_iterations)
        v -= model.step * (weights * (jacobian.T @ tensions)).reshape(-1, 3)


def conjugate_gradients(
        matrix: sparse.csr_matrix, right: np.ndarray, tolerance: float,
        most_iterations: int) -> tuple[np.ndarray, int]:
    """Return the solution from zero, and the iterations; no preconditioner, as in the paper."""
    found = np.zeros_like(right)
    residual, direction = right.copy(), right.copy()
    square = float(residual @ residual)
    enough = square * tolerance**2
    for iteration in range(most_iterations):
        if square <= enough:
            return found, iteration
        image = matrix @ direction
        length = square / float(direction @ image)
        found += length * direction
        residual -= length * image
        square, last = float(residual @ residual), square
        direction = residual + square / last * direction
    return found, most_iterations
