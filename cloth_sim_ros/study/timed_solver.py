# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The solvers that can be timed side by side, each with its set-up, for one state and step."""

from dataclasses import dataclass
from typing import Any
from typing import Protocol

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import choose_layout
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import hard_edges
from cloth_sim_ros.sim.solver.edge_law import spring_law
from cloth_sim_ros.sim.solver.solver import Solver
from cloth_sim_ros.sim.solver.tally import SolveReport
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.study.paper_solver import PaperSolver
import numpy as np

Fields = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Step:
    """
    A step to solve.

    :param hard: edges that keep their length, in place of springs
    :param dt: its length [s]
    """

    hard: bool
    dt: float

    def law(self, scene: Scene) -> EdgeLaw:
        """Return the law of its edges, without the geometric mass term."""
        if self.hard:
            return hard_edges(scene, self.dt, strain=scene['constraint.strain'])
        return spring_law(scene, self.dt)

    def __str__(self) -> str:
        """Return it in words."""
        return f'{"hard" if self.hard else "springs"}, dt {self.dt} s'


STEPS = tuple(Step(hard, dt) for hard in (False, True) for dt in (0.01, 0.005))


class TimedSolver(Protocol):
    """What is measured: ``solve`` does all that a new state asks for."""

    name: str
    step: Step

    def __init__(self, context: Context, scene: Scene, state: Fields, step: Step) -> None:
        """Compile and upload what stays."""

    @classmethod
    def can_solve(cls, step: Step) -> bool:
        """Return whether ``step`` is of its kind."""

    def solve(self) -> None:
        """Set up and solve the step."""

    def report(self) -> SolveReport:
        """Return how the last solve ended."""

    def solution(self) -> np.ndarray:
        """Return dv [m/s], (rows, cols, 3)."""

    def delete(self) -> None:
        """Give the buffers back."""


class _SolverStep:
    name: str
    options: dict[str, Any] = {}

    def __init__(self, context: Context, scene: Scene, state: Fields, step: Step) -> None:
        """Write the state and compile the passes."""
        self.step = step
        layout = choose_layout(scene, context)
        self._state = State(layout, state[0], scene.pinned_nodes())
        self._state.write(*state)
        self._forcing = Forcing(scene['gravity'])
        self._solver = Solver(
            scene, layout, families=('structural', 'shear') if step.hard else FAMILIES,
            preconditioner=self.name, **self.options)
        self._solver.set_law(step.law(scene))
        self.report = self._solver.report
        self.solution = self._solver.solution

    @classmethod
    def can_solve(cls, step: Step) -> bool:
        """Return that it solves any step."""
        return True

    def solve(self) -> None:
        """Set up and solve the step."""
        self._solver.prepare(self._state, self._forcing)
        self._solver.solve()

    def delete(self) -> None:
        """Give the buffers back."""
        self._solver.delete()
        self._state.delete()


class MultigridStep(_SolverStep):
    """The solver of the modes; it starts from nothing each time, as in a first step."""

    name = 'multigrid'
    options = {'max_iterations': 100}


class BlockJacobiStep(_SolverStep):
    """The same without coarser levels, which takes hundreds of iterations."""

    name = 'block_jacobi'
    options = {'max_iterations': 1000}


class PaperStep(PaperSolver):
    """The solver of the paper."""

    name = 'paper'

    def __init__(self, context: Context, scene: Scene, state: Fields, step: Step) -> None:
        """Compile its shaders and upload the state."""
        self.step = step
        super().__init__(scene, *state, step.dt)

    @classmethod
    def can_solve(cls, step: Step) -> bool:
        """Return whether the edges keep their length: the paper has no others in its system."""
        return step.hard


BASELINES: dict[str, type[TimedSolver]] = {
    kind.name: kind for kind in (PaperStep, BlockJacobiStep)}
