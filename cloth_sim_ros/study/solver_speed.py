# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How fast and how exactly the implicit step is solved, set-up included, on one device."""

from collections.abc import Iterator
from collections.abc import Sequence
from dataclasses import asdict
from dataclasses import dataclass
import statistics
import time

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.reference.edges import Edges
from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.model.edge_kinds import rest_lengths
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.study.timed_solvers import MultigridStep
from cloth_sim_ros.study.timed_solvers import STEPS
from cloth_sim_ros.study.timed_solvers import TimedSolver
import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu


def direct_step(
        scene: Scene, law: EdgeLaw, positions: np.ndarray, velocities: np.ndarray) -> np.ndarray:
    """
    Return dv [m/s] of the step that ``law`` describes, (rows, cols, 3), by a sparse LU.

    It is the first solve of a cloth without tensions, so that there is no geometric mass term,
    with lengths foreseen along the edges alone.

    :param positions: (rows, cols, 3) [m]
    :param velocities: (rows, cols, 3) [m/s]
    """
    h = law.length
    x, v = (field.reshape(-1, 3).astype(float) for field in (positions, velocities))
    free = ~scene.pinned_nodes().ravel()
    edges = edges_of(scene, FAMILIES)
    directions = edges.directions(x)
    rates = edges.along(v, directions)
    tension, weight = _pull(scene, law, edges, edges.lengths(x) + h * rates, rates)
    jacobian = edges.jacobian(directions, len(x))[:, np.repeat(free, 3)]
    matrix = sparse.identity(jacobian.shape[1]) + jacobian.T @ sparse.diags(weight) @ jacobian
    right = h * np.tile(scene['gravity'], np.count_nonzero(free)) - h * (jacobian.T @ tension)
    change = np.zeros_like(x)
    change[free] = splu(matrix.tocsc()).solve(right).reshape(-1, 3)
    return change.reshape(positions.shape)


def _pull(
        scene: Scene, law: EdgeLaw, edges: Edges, lengths: np.ndarray,
        rates: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the tension over the node mass [m/s2] and the weight in the matrix of each edge."""
    family = np.array([FAMILIES.index(name) for name in edges.family], dtype=int)
    kind = _rest_kinds(scene, edges)
    stiffness, damping = (np.array(values)[kind] for values in (law.stiffness, law.damping))
    shortest, longest = (np.array(values)[family] for values in (law.shortest, law.longest))
    rest = edges.rest_length
    # 1 / E goes with the inverse of the rest length.
    limit_stiffness = law.limit_stiffness[0] * rest_lengths(scene)[0] / rest
    beyond = np.maximum(lengths - longest * rest, 0.0)
    has_lower = shortest > 0.0
    beyond[has_lower] += np.minimum(lengths - shortest * rest, 0.0)[has_lower]
    in_force = (beyond != 0.0) | (shortest == longest)
    tension = stiffness * (lengths - rest) + damping * rates + limit_stiffness * beyond
    slope = stiffness + in_force * limit_stiffness
    return tension, law.length * (law.length * slope + damping)


def _rest_kinds(scene: Scene, edges: Edges) -> np.ndarray:
    """Return the place of each edge in what has a value for every rest length."""
    kinds = np.zeros(len(edges), dtype=int)
    (first_row, first_col), (row, col) = (
        np.divmod(nodes, scene.cols) for nodes in (edges.first, edges.second))
    for kind in EDGE_KINDS:
        kinds[(abs(row - first_row) == abs(kind.drow)) & (
            abs(col - first_col) == abs(kind.dcol))] = kind.rest
    return kinds


# The unit scene of docs/explanation/numerics.md in mid-drape, to measure on its states.

_STIFFNESS = 1000.0
# Less than the solved step has: explicit damping shortens the substeps of the drape.
_DRAPE_DAMPING = 1e-6 * _STIFFNESS
_SOLVE_DAMPING = 5e-4 * _STIFFNESS


def unit_scene(size: int) -> Scene:
    """Return the unit scene of ``size`` x ``size`` nodes with k = 1000 N/m, as it is solved."""
    return _scene(size, _SOLVE_DAMPING)


def draped_states(
        size: int, times: Sequence[float], context: Context
        ) -> list[tuple[np.ndarray, np.ndarray]]:
    """
    Return positions [m] and velocities [m/s] at rising ``times`` [s] after a level start.

    The cloth is stepped by mode mass_spring.
    """
    simulation = Simulation(_scene(size, _DRAPE_DAMPING), context=context)
    states = []
    for begin, end in zip((0.0, *times), times):
        simulation.advance(end - begin)
        snapshot = simulation.snapshot()
        states.append((snapshot.positions, snapshot.velocities))
    simulation.close()
    return states


def _scene(size: int, damping: float) -> Scene:
    return Scene({
        'rows': size, 'cols': size, 'dt': 0.01,
        'stiffness.structural': _STIFFNESS, 'stiffness.shear': _STIFFNESS,
        'stiffness.bend': 0.1 * _STIFFNESS,
        'damping.structural': damping, 'damping.shear': damping, 'damping.bend': 0.1 * damping})


DRAPE_TIMES = (0.2, 0.5, 1.0)


@dataclass(frozen=True)
class SolveSpeed:
    """
    Solves a second of one step.

    :param solver: multigrid, or the name of the baseline
    :param step: springs or hard, and dt [s]
    :param drape_time: when the state was taken [s]
    :param residual: as the solver measures it: over the change of velocity, that of the paper's
        over the one at its start
    :param reached: whether that is the 1e-2 requested
    :param velocity_error: norm of dv less that of a direct float64 solve, over that norm
    :param median: solves a second, over the rounds
    :param rounds: each round's figure
    """

    solver: str
    step: str
    drape_time: float
    iterations: int
    residual: float
    reached: bool
    velocity_error: float
    median: float
    rounds: tuple[float, ...]


@dataclass(frozen=True)
class SolverComparison:
    """
    The steps at one size.

    :param ratios: of multigrid to the baseline in the same step and round, where there is one
    """

    rows: int
    cols: int
    device: str
    speeds: tuple[SolveSpeed, ...]
    ratios: tuple[float, ...]

    def as_dict(self) -> dict[str, object]:
        """Return plain values for JSON."""
        return asdict(self)


def compare_solvers(
        sizes: Sequence[int], rounds: int, round_seconds: float, *,
        times: Sequence[float] = DRAPE_TIMES,
        baseline: type[TimedSolver] | None = None) -> Iterator[SolverComparison]:
    """
    Yield the comparison for each size on a cloth in mid-drape; in a round each has its turn.

    :param sizes: nodes along each side
    :param round_seconds: wall time that each turn aims at [s]
    :param times: of the drape, rising [s]
    :param baseline: what is measured beside multigrid, in the steps it can solve
    """
    context = Context(single_thread=True)
    for size in sizes:
        runs = _runs(size, context, times, baseline)
        counts = [run.count_for(round_seconds) for run in runs]
        for _ in range(rounds):
            for run, count in zip(runs, counts):
                run.measure(count)
        yield SolverComparison(
            size, size, context.device, tuple(run.speed() for run in runs), _ratios(runs))
        for run in runs:
            run.solver.delete()
    context.close()


class _Run:
    def __init__(
            self, context: Context, solver: TimedSolver, drape_time: float,
            expected: np.ndarray) -> None:
        self.solver = solver
        self.figures: list[float] = []
        self._context = context
        self._drape_time = drape_time
        self._expected = expected

    def count_for(self, seconds: float) -> int:
        # The first solve compiles what the device puts off until then.
        self._time_solves(1)
        return max(1, round(seconds / self._time_solves(1)))

    def measure(self, count: int) -> None:
        self.figures.append(count / self._time_solves(count))

    def speed(self) -> SolveSpeed:
        report = self.solver.report()
        off = np.linalg.norm(self.solver.solution() - self._expected)
        return SolveSpeed(
            self.solver.name, str(self.solver.step), self._drape_time, report.iterations,
            report.residual, report.reached, float(off / np.linalg.norm(self._expected)),
            statistics.median(self.figures), tuple(self.figures))

    def _time_solves(self, count: int) -> float:
        self._context.finish()
        begin = time.perf_counter()
        for _ in range(count):
            self.solver.solve()
        self._context.finish()
        return time.perf_counter() - begin


def _runs(
        size: int, context: Context, times: Sequence[float],
        baseline: type[TimedSolver] | None) -> list[_Run]:
    scene = unit_scene(size)
    runs = []
    for drape_time, state in zip(times, draped_states(size, times, context)):
        for step in STEPS:
            if baseline and not baseline.can_solve(step):
                continue
            expected = direct_step(scene, step.law(scene), *state)
            for kind in (MultigridStep, baseline):
                if kind:
                    solver = kind(context, scene, state, step)
                    runs.append(_Run(context, solver, drape_time, expected))
    return runs


def _ratios(runs: Sequence[_Run]) -> tuple[float, ...]:
    if all(isinstance(run.solver, MultigridStep) for run in runs):
        return ()
    return tuple(
        own / other for first, second in zip(runs[::2], runs[1::2])
        for own, other in zip(first.figures, second.figures))
