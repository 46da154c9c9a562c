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

"""How fast the implicit step is solved, set-up included, measured side by side on one device."""

from collections.abc import Iterator
from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import asdict
from dataclasses import dataclass
import statistics
import time
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import choose_layout
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.solver.edge_law import hard_edges
from cloth_sim_ros.sim.solver.edge_law import implicit_springs
from cloth_sim_ros.sim.solver.solver import Solver
from cloth_sim_ros.sim.state import State
import numpy as np

_STIFFNESS = 1000.0
_DRAPE_TIME = 0.2
_UNIT = {
    'stiffness.structural': _STIFFNESS, 'stiffness.shear': _STIFFNESS,
    'stiffness.bend': 0.1 * _STIFFNESS}
# Less than the solved step has: explicit damping shortens the substeps of the drape.
_DRAPE_DAMPING = 1e-6 * _STIFFNESS
_SOLVE_DAMPING = 5e-4


@dataclass(frozen=True)
class SolveSpeed:
    """
    Solves a second of one step.

    :param step: springs or hard, and dt [s]
    :param median: over the rounds
    :param rounds: each round's figure
    """

    step: str
    preconditioner: str
    iterations: int
    residual: float
    median: float
    rounds: tuple[float, ...]


@dataclass(frozen=True)
class SolverComparison:
    """The steps and preconditioners at one size."""

    rows: int
    cols: int
    device: str
    speeds: tuple[SolveSpeed, ...]

    def as_dict(self) -> dict[str, object]:
        """Return plain values for JSON."""
        return asdict(self)


def compare_solvers(
        sizes: Sequence[int], rounds: int, round_seconds: float,
        preconditioners: Sequence[str] = ('multigrid', 'block_jacobi'),
        options: Mapping[str, Any] | None = None) -> Iterator[SolverComparison]:
    """
    Yield the comparison for each size on a cloth in mid-drape; in a round each has its turn.

    :param sizes: nodes along each side
    :param round_seconds: wall time that each turn aims at [s]
    :param options: of Solver, besides the preconditioner
    """
    context = Context(single_thread=True)
    for size in sizes:
        positions, velocities = draped_state(size, context)
        runs = [
            _Run(size, context, positions, velocities, name, hard, dt, options or {})
            for name in preconditioners for hard in (False, True) for dt in (0.01, 0.005)]
        counts = [run.count_for(round_seconds) for run in runs]
        measured: list[list[float]] = [[] for _ in runs]
        for _ in range(rounds):
            for run, count, figures in zip(runs, counts, measured):
                figures.append(count / run.time_solves(count))
        yield SolverComparison(
            size, size, context.device,
            tuple(run.speed(figures) for run, figures in zip(runs, measured)))
        for run in runs:
            run.delete()
    context.close()


def draped_state(size: int, context: Context) -> tuple[np.ndarray, np.ndarray]:
    """Return positions and velocities of the unit scene in mid-drape, by mass-spring."""
    simulation = Simulation(
        Scene({'rows': size, 'cols': size, 'dt': 0.01, **_UNIT, **_damping(_DRAPE_DAMPING)}),
        context=context)
    simulation.advance(_DRAPE_TIME)
    snapshot = simulation.snapshot()
    simulation.close()
    return snapshot.positions, snapshot.velocities


class _Run:
    def __init__(
            self, size: int, context: Context, positions: np.ndarray, velocities: np.ndarray,
            preconditioner: str, hard: bool, dt: float, options: Mapping[str, Any]) -> None:
        scene = Scene({
            'rows': size, 'cols': size, **_UNIT, **_damping(_SOLVE_DAMPING * _STIFFNESS)})
        layout = choose_layout(scene, context)
        self._context = context
        self._state = State(layout, positions, scene.pinned_nodes())
        self._state.write(positions, velocities)
        self._forcing = Forcing(scene['gravity'])
        self._step = f'{"hard" if hard else "springs"}, dt {dt} s'
        self._preconditioner = preconditioner
        families = ('structural', 'shear') if hard else FAMILIES
        # Block-Jacobi needs hundreds of iterations where multigrid needs some ten.
        most = 20 if preconditioner == 'multigrid' else 1000
        self._solver = Solver(
            scene, layout, families=families, preconditioner=preconditioner,
            **{'max_iterations': most, **options})
        self._solver.set_law(hard_edges(dt) if hard else implicit_springs(scene, dt))

    def count_for(self, seconds: float) -> int:
        # The first solve compiles what the device puts off until then.
        self.time_solves(1)
        return max(1, round(seconds / self.time_solves(1)))

    def time_solves(self, count: int) -> float:
        self._context.finish()
        begin = time.perf_counter()
        for _ in range(count):
            self._solver.assemble(self._state)
            self._solver.make_right_side(self._state, self._forcing)
            self._solver.solve()
        self._context.finish()
        return time.perf_counter() - begin

    def speed(self, figures: Sequence[float]) -> SolveSpeed:
        report = self._solver.report()
        return SolveSpeed(
            self._step, self._preconditioner, report.iterations, report.residual,
            statistics.median(figures), tuple(figures))

    def delete(self) -> None:
        self._solver.delete()
        self._state.delete()


def _damping(value: float) -> dict[str, float]:
    return {
        'damping.structural': value, 'damping.shear': value, 'damping.bend': 0.1 * value}
