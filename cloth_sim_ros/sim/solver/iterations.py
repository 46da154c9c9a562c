# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The iterations of conjugate gradients, of which the device decides when to stop."""

from cloth_sim_ros.gl.buffer import dispatches_visible_call
from cloth_sim_ros.gl.buffer import shader_dispatches_visible
from cloth_sim_ros.gl.quick_calls import make
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.solver import surface_contacts as kinds
from cloth_sim_ros.sim.solver.preconditioner import Preconditioner
from cloth_sim_ros.sim.solver.solver_buffers import Levels
from cloth_sim_ros.sim.solver.solver_buffers import MOST_LEVELS
from cloth_sim_ros.sim.solver.solver_buffers import PRECONDITIONED
from cloth_sim_ros.sim.solver.solver_buffers import PRODUCT
from cloth_sim_ros.sim.solver.solver_buffers import SOLUTION
from cloth_sim_ros.sim.solver.solver_buffers import SolverBuffers
from cloth_sim_ros.sim.solver.solver_programs import PassList
from cloth_sim_ros.sim.solver.solver_programs import POINT_LOCAL
from cloth_sim_ros.sim.solver.solver_programs import POINTS
from cloth_sim_ros.sim.solver.solver_programs import SolverPass
from cloth_sim_ros.sim.solver.solver_programs import SolverPrograms
from cloth_sim_ros.sim.solver.start import Start
from cloth_sim_ros.sim.solver.surface_contacts import SolverSurface
from cloth_sim_ros.sim.stop import leave_if
from cloth_sim_ros.sim.stop import Stop
import numpy as np

# Iterations that are submitted together [1] where to ask in between is a wait (a GPU).
_BATCH = 4
# Max. sizes of passes that reduce.comp switches off [1]: three for each level.
_MOST_GROUPS_COUNTS = 3 * MOST_LEVELS


class Iterations:
    """
    Finds the solution of the system and right side that stand in ``buffers``.

    ``made`` are the iterations of the last solve.

    :param state: how the state is stored
    :param most: iterations of a solve
    :param surface: contacts of edges and faces; None where there can be none
    """

    def __init__(
            self, state: Layout, levels: Levels, programs: SolverPrograms,
            preconditioner: Preconditioner, most: int,
            surface: SolverSurface | None = None) -> None:
        """Compile the passes, and allocate what is small of the buffers."""
        cloth = levels.cloth
        self._surface = surface
        self._begin = SolverPass(programs.make('begin.comp'), cloth.groups)
        self._update = SolverPass(
            programs.make('update.comp'), (-(-cloth.stored // (POINTS * POINT_LOCAL)), 1))
        # With contacts of edges and faces, another pass adds to the sums.
        reduces = programs.has_few_dispatches and surface is None
        product = programs.make(
            'product.comp', REDUCES=int(reduces), MOST_GROUPS_COUNTS=_MOST_GROUPS_COUNTS)
        self.multiply = SolverPass(product, cloth.groups)
        dispatches = [(1, 1)]
        cycles = [[*preconditioner.cycle, self.multiply]]
        begins = [[self._begin]]
        if surface is not None:
            begins.append([self._begin, surface.adds_to(kinds.RESIDUAL, SOLUTION)])
            cycles.append([
                *preconditioner.cycle_in_contact, self.multiply,
                surface.adds_to(kinds.PRODUCT, PRECONDITIONED, PRODUCT)])
        for each in (*(each for cycle in cycles for each in cycle), self._update):
            each.switch(dispatches)
        self.buffers = SolverBuffers(levels, len(dispatches))
        reduce = product if reduces else programs.make(
            'reduce.comp', MOST_GROUPS_COUNTS=_MOST_GROUPS_COUNTS)
        reduce.use()
        reduce.set_int('groups_count', len(dispatches))
        reduce.set_int_vectors('groups_of_each', np.array(dispatches))
        reduce.set_int('sum_count', self.buffers.sum_count)
        # With contact there is one sum more.
        self._passes = [
            _Passes(begin, cycle, self._update, [] if reduces else [SolverPass(
                reduce, (1, 1), sum_count=self.buffers.sum_count + more)])
            for more, (begin, cycle) in enumerate(zip(begins, cycles))]
        self.made = 0
        self._most = most
        self._reduce = reduce
        self._batch = 1 if state.texture_loads else _BATCH
        self._first_batch = 0 if self._batch == 1 else self._batch

    def start_from(self, start: Start, left_share: float) -> None:
        """
        Choose where the next solve starts.

        :param left_share: share of the residual of the pass before to be solved for as well [1]
        """
        self._begin.set_int('start_field', start.field)
        self._begin.set_float('guess', start.share)
        self._begin.set_float('left_share', left_share)

    def stop_at(
            self, tolerance: float, *, least_scale: float | None, may_stay: bool,
            early: float) -> None:
        """
        Choose where the next solve stops.

        :param tolerance: over the scale, the change of velocity in the step
        :param least_scale: the square of the least change; None to keep the scale there is
        :param may_stay: True where the solve begins may be the solution
        :param early: of the residual at the start, what may be left in any case
        """
        self._reduce.use()
        self._reduce.set_float('tolerance_square', tolerance**2)
        self._reduce.set_int('sets_scale', int(least_scale is not None))
        self._reduce.set_float('least_scale', least_scale or 0.0)
        self._reduce.set_int('may_stay', int(may_stay))
        self._reduce.set_float('early_square', early**2)

    def solve(self, stop: Stop) -> None:
        """Find the solution; raise StepAbandoned where ``stop`` asks for it in between."""
        self.buffers.bind()
        is_in_contact = self._surface is not None and self._surface.has_contacts
        passes = self._passes[int(is_in_contact)]
        if self._surface is not None and is_in_contact:
            self._surface.bind()
        passes.run_first(stop)
        shader_dispatches_visible()
        self._go_on(passes, stop)
        self._update.run()

    def _go_on(self, passes: '_Passes', stop: Stop) -> None:
        # To ask whether the device goes on costs little where that is this processor, and a wait
        # elsewhere: there, as many are submitted at once as the last solve took, before asking.
        made, batch, is_going = 1, self._first_batch, True
        while is_going:
            batch = min(batch, self._most - made)
            if batch > 0:
                leave_if(stop)
            for _ in range(batch):
                make(passes.further_calls)
            made += batch
            self.made, is_going = self.buffers.progress()
            is_going = is_going and made < self._most
            batch = self._batch
        if self._batch > 1:
            self._first_batch = max(self.made - 1, 0)
        passes.submitted(made - 1)


class _Passes:
    """
    Those of the first iteration and of further ones.

    :param begin: what comes before the first one
    :param reduce: the pass that adds up sums, where the last of ``cycle`` does not
    """

    def __init__(
            self, begin: list[SolverPass], cycle: list[SolverPass], update: SolverPass,
            reduce: list[SolverPass]) -> None:
        self._first = [*begin, *cycle, *reduce]
        self._further = [update, *cycle, *reduce]
        self.further_calls = [
            call for each in self._further for call in each.calls_if_going()]
        self.further_calls.append(dispatches_visible_call())
        # None until all passes have run: the driver compiles each as it first does.
        self._first_go: PassList | None = None

    def run_first(self, stop: Stop) -> None:
        """Begin, and make the first iteration."""
        if self._first_go is None:
            for each in self._first:
                each.run()
                leave_if(stop)
            self._first_go = PassList([each] for each in self._first)
        else:
            self._first_go.run()

    def submitted(self, count: int) -> None:
        """Count ``count`` times that the calls of a further iteration were made."""
        for each in self._further:
            each.submitted(count)
