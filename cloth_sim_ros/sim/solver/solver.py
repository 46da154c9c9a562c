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

"""Preconditioned conjugate gradients on the device, which decides itself when to stop."""

from collections.abc import Generator

from cloth_sim_ros.gl.buffer import DISPATCHES_VISIBLE
from cloth_sim_ros.gl.buffer import shader_dispatches_visible
from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.block_jacobi import BlockJacobi
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.levels import Levels
from cloth_sim_ros.sim.solver.levels import MOST_LEVELS
from cloth_sim_ros.sim.solver.multigrid import Multigrid
from cloth_sim_ros.sim.solver.preconditioner import Preconditioner
from cloth_sim_ros.sim.solver.right_side import RightSide
from cloth_sim_ros.sim.solver.solve_report import report_of
from cloth_sim_ros.sim.solver.solve_report import SolveReport
from cloth_sim_ros.sim.solver.solver_buffers import PRECONDITIONED
from cloth_sim_ros.sim.solver.solver_buffers import PRODUCT
from cloth_sim_ros.sim.solver.solver_buffers import RESIDUAL
from cloth_sim_ros.sim.solver.solver_buffers import SOLUTION
from cloth_sim_ros.sim.solver.solver_buffers import SolverBuffers
from cloth_sim_ros.sim.solver.solver_pass import SolverPass
from cloth_sim_ros.sim.solver.solver_programs import POINT_LOCAL
from cloth_sim_ros.sim.solver.solver_programs import POINTS
from cloth_sim_ros.sim.solver.solver_programs import SolverPrograms
from cloth_sim_ros.sim.solver.tally import Tally
from cloth_sim_ros.sim.solver.tally import TallyReport
from cloth_sim_ros.sim.solver.tensions import Tensions
from cloth_sim_ros.sim.state import State
import numpy as np

PRECONDITIONERS: dict[str, type[Preconditioner]] = {
    'multigrid': Multigrid, 'block_jacobi': BlockJacobi}

# Of the tolerance. What the last iteration leaves is foretold, not measured.
_AIM = 0.8
# Passes of one size can be switched off together: some for each level.
_MOST_GROUPS_COUNTS = 3 * MOST_LEVELS


class Solver:
    """
    Solves (M + J^T diag(a) J) dv = b for the free nodes of a cloth.

    :param state: how the state is stored
    :param families: of the edges in the system; None takes those the scene models
    :param tolerance: sqrt((r, B r)) over that at the start, r the residual and B the
        preconditioner
    :param foresees_turn: let the right side allow for how much longer edges get by turning
    :param keeps_tension: find the tension of each edge; needed for further solves of a step
    :param has_damping: further solves have edges with damping among them
    """

    def __init__(
            self, scene: Scene, state: Layout, *, families: tuple[str, ...] | None = None,
            preconditioner: str = 'multigrid', tolerance: float = 1e-2,
            max_iterations: int = 12, foresees_turn: bool = False,
            keeps_tension: bool = False, has_damping: bool = False) -> None:
        """Compile the passes and allocate the buffers."""
        if families is None:
            families = tuple(family for family in FAMILIES if scene.models(family))
        kind = PRECONDITIONERS[preconditioner]
        levels = Levels(state, coarsen=kind.is_multigrid)
        self._programs = SolverPrograms(
            state, levels, families, is_multigrid=kind.is_multigrid)
        self._right_side = RightSide(
            scene, state, self._programs, levels, foresees_turn=foresees_turn,
            keeps_tension=keeps_tension, has_lag=has_damping)
        self._tensions = Tensions(
            scene, self._programs, levels, has_lag=has_damping) if keeps_tension else None
        self._tally = Tally(self._programs, tolerance)
        self._preconditioner = kind(self._programs, levels)
        self._iterations = max_iterations
        self._tolerance = tolerance
        self._law: EdgeLaw | None = None
        self._compile(levels)

    def set_law(self, law: EdgeLaw) -> None:
        """Take the weights of the edges and the length of the step from ``law``."""
        if law != self._law:
            self._law = law
            self._programs.set_law(law)
            self._preconditioner.set_law(law)

    def submit(self, iterations: int) -> None:
        """Let solves from now on stop after ``iterations`` in any case."""
        self._iterations = iterations

    def assemble(self, state: State) -> None:
        """Take up positions and pins, and prepare the preconditioner."""
        self._buffers.bind()
        state.bind_in()
        for each in (self._take_up, self._assemble, *self._preconditioner.assembly):
            each.run()

    def make_right_side(
            self, state: State, forcing: Forcing, offset_share: float = 0.0) -> None:
        """
        Make b = h (M a - J^T pull C) - J^T a J v, after ``assemble``.

        :param forcing: what accelerates the nodes besides the edges
        :param offset_share: of the offsets of rest lengths, in effect at the end of the step
        """
        self._buffers.bind()
        state.bind_in()
        if self._tensions is not None:
            self._tensions.bind()
        self._right_side.run(self._law, forcing, offset_share)

    def make_later_right_side(self, offset_share: float = 0.0) -> None:
        """Make b of what is left of each edge's law, after ``apply`` and another ``assemble``."""
        self._buffers.bind()
        self._tensions.bind()
        self._tensions.later_right_side.set_float('offset_share', offset_share)
        self._tensions.later_right_side.run()

    def set_right_side(self, values: np.ndarray) -> None:
        """Take (rows, cols, 3) ``values``, zero at pinned nodes, as b over the node mass [m/s]."""
        self._buffers.write(RESIDUAL, values)

    def right_side(self) -> np.ndarray:
        """Return b over the node mass [m/s], (rows, cols, 3); ``solve`` uses it up."""
        return self._buffers.read(RESIDUAL)

    def solve(self) -> None:
        """Find the solution; returns before the device has it."""
        for _ in self.solve_in_pieces():
            pass

    def solve_in_pieces(self) -> Generator[None, bool | None, None]:
        """Do the same, and yield where the device may do something else; as Mode.step does."""
        self._buffers.bind()
        self._buffers.clear_scalars()
        self._begin.run()
        for each in self._iteration:
            each.run()
            if (yield):
                self._buffers.bind()
        shader_dispatches_visible()
        # Most of these run nothing: what they cost is the calls.
        for _ in range(self._iterations - 1):
            for call, arguments in self._further_calls:
                call(*arguments)
            if (yield):
                self._buffers.bind()
        for each in self._further:
            each.submitted(self._iterations - 1)
        self._update.run()
        self._tally.add()
        if self._tensions is not None:
            self._tensions.bind()
            self._tensions.find.run()

    def apply(
            self, state: State, *, further: bool = False,
            common_change: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> None:
        """
        Add the solution to the velocities and move the nodes for the length of the step.

        :param further: True after ``make_later_right_side``: the nodes have moved before
        :param common_change: of all velocities, besides the solution [m/s]
        """
        self._buffers.bind()
        state.bind_in()
        state.bind_out()
        self._apply.set_int('is_further', int(further))
        self._apply.set_vectors('common_change', common_change)
        self._apply.run()
        state.swap()

    def multiply(self, values: np.ndarray) -> np.ndarray:
        """Return the matrix over the node mass times ``values``, both (rows, cols, 3)."""
        self._buffers.bind()
        self._buffers.write(PRECONDITIONED, values)
        self._multiply.run()
        return self._buffers.read(PRODUCT)

    def solution(self) -> np.ndarray:
        """Return dv [m/s], (rows, cols, 3) float32."""
        return self._buffers.read(SOLUTION)

    @property
    def tensions(self) -> Tensions | None:
        """Return the tensions that the solves of the last step have found; None if not kept."""
        return self._tensions

    def forget(self) -> None:
        """Drop what earlier solves have left, also where they came to no numbers."""
        self._buffers.clear()
        if self._tensions is not None:
            self._tensions.clear()
        self._tally.clear()

    def clear_tally(self) -> None:
        """Begin to count solves anew."""
        self._tally.clear()

    def tally(self) -> TallyReport:
        """Return how the solves ended since then."""
        return self._tally.report()

    def report(self) -> SolveReport:
        """Return how the last solve ended."""
        _, _, _, start, after, iterations = (float(value) for value in self._buffers.scalars())
        return report_of(start, after, int(iterations), self._tolerance)

    def measured_residual(self) -> float:
        """Return the residual as it was before the last iteration of the last solve."""
        _, _, measure, start, _, _ = (float(value) for value in self._buffers.scalars())
        return report_of(start, measure, 0, self._tolerance).residual

    def delete(self) -> None:
        """Give the buffers back."""
        self._buffers.delete()
        self._tally.delete()
        if self._tensions is not None:
            self._tensions.delete()

    def _compile(self, levels: Levels) -> None:
        cloth = levels.cloth
        points = (-(-cloth.stored // (POINTS * POINT_LOCAL)), 1)
        nodes = cloth.node_groups
        programs = self._programs
        self._take_up = SolverPass(programs.make('take_up.comp'), nodes)
        self._assemble = SolverPass(programs.make('assemble.comp'), nodes)
        self._begin = SolverPass(programs.make('begin.comp'), points)
        self._multiply = SolverPass(programs.make('product.comp'), cloth.groups)
        self._update = SolverPass(programs.make('update.comp'), points)
        self._apply = SolverPass(programs.make('apply.comp'), nodes)
        dispatches = [(1, 1)]
        self._iteration = [*self._preconditioner.cycle, self._multiply]
        for each in (*self._iteration, self._update):
            each.switch(dispatches)
        reduce = programs.make('reduce.comp', MOST_GROUPS_COUNTS=_MOST_GROUPS_COUNTS)
        reduce.set_int('groups_count', len(dispatches))
        reduce.set_int_vectors('groups_of_each', np.array(dispatches))
        self._iteration.append(SolverPass(reduce, (1, 1)))
        self._further = [self._update, *self._iteration]
        self._further_calls = [
            call for each in self._further for call in each.calls_if_going()]
        self._further_calls.append(DISPATCHES_VISIBLE)
        self._buffers = SolverBuffers(levels, len(dispatches))
        reduce.set_int('sum_count', self._buffers.sum_count)
        reduce.set_float('tolerance_square', (_AIM * self._tolerance)**2)
