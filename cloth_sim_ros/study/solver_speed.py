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
from cloth_sim_ros.study.direct_step import direct_step
from cloth_sim_ros.study.draped_cloth import draped_states
from cloth_sim_ros.study.draped_cloth import unit_scene
from cloth_sim_ros.study.timed_solver import MultigridStep
from cloth_sim_ros.study.timed_solver import STEPS
from cloth_sim_ros.study.timed_solver import TimedSolver
import numpy as np

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
    :param reached: whether that is the 1e-2 asked for
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
