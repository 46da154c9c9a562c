# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The solves of an implicit step, by preconditioned conjugate gradients on the device."""

from dataclasses import replace

from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.low_parts import needs_low_parts
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.active_set import HeldPass
from cloth_sim_ros.sim.solver.active_set import LimitSearch
from cloth_sim_ros.sim.solver.active_set import RightSide
from cloth_sim_ros.sim.solver.active_set import SolverContacts
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.iterations import Iterations
from cloth_sim_ros.sim.solver.preconditioner import BlockJacobi
from cloth_sim_ros.sim.solver.preconditioner import Multigrid
from cloth_sim_ros.sim.solver.preconditioner import Preconditioner
from cloth_sim_ros.sim.solver.solver_buffers import BEND_TENSION
from cloth_sim_ros.sim.solver.solver_buffers import CHANGE
from cloth_sim_ros.sim.solver.solver_buffers import LEFT
from cloth_sim_ros.sim.solver.solver_buffers import Levels
from cloth_sim_ros.sim.solver.solver_buffers import PRECONDITIONED
from cloth_sim_ros.sim.solver.solver_buffers import PRODUCT
from cloth_sim_ros.sim.solver.solver_buffers import RESIDUAL
from cloth_sim_ros.sim.solver.solver_buffers import SOLUTION
from cloth_sim_ros.sim.solver.solver_buffers import START
from cloth_sim_ros.sim.solver.solver_buffers import TENSION
from cloth_sim_ros.sim.solver.solver_programs import PassList
from cloth_sim_ros.sim.solver.solver_programs import SolverPass
from cloth_sim_ros.sim.solver.solver_programs import SolverPrograms
from cloth_sim_ros.sim.solver.start import Start
from cloth_sim_ros.sim.solver.surface_contacts import SolverSurface
from cloth_sim_ros.sim.solver.tally import least_scale
from cloth_sim_ros.sim.solver.tally import report_of
from cloth_sim_ros.sim.solver.tally import SolveReport
from cloth_sim_ros.sim.solver.tally import Tally
from cloth_sim_ros.sim.solver.tally import TallyReport
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stop import never
from cloth_sim_ros.sim.stop import Stop
import numpy as np

PRECONDITIONERS: dict[str, type[Preconditioner]] = {
    'multigrid': Multigrid, 'block_jacobi': BlockJacobi}

# Residual at which a solve stops, over the tolerance [1], as that of the last iteration is
# foretold; chosen: iterations go from +12 % at 0.4 to -2 % at 1 (constants.py --only _AIM).
_AIM = 0.8
# Error of the tensions at which a pass ends, over the tolerance [1]; chosen: nodes move by < 1 %
# of their way from 0.1 to 2, solves go from +12 to -13 % (constants.py --only _LACKING).
_LACKING = 0.5
# Residual of an early solve, over that at its start [1]; chosen: nodes move by 1 % of their way
# from 0.1 to 0.9, 0 costs 12 % more iterations (constants.py --only _EARLY).
_EARLY = 0.3
# Tolerance of solves in contact with thin colliders, over that of others [1], so that fewer
# follow; chosen: time changes by 15 % from 0.03 to 0.3, 1 takes a quarter longer at 33 x 33.
_IN_CONTACT = 0.1
# Part of the way of an early solve that the line search goes [1], below which the solves that
# follow are exact; chosen: nodes move by < 0.01 % of their way from 0 to 0.75, iterations by 3 %
# at 1.1 (constants.py --only _HALF).
_HALF = 0.5


class Solver:
    """
    Solves (M + J^T a J + beta h^2 (K_geo + K_bend)) dv = b for the free nodes of a cloth.

    Tensions stay from solve to solve: K_geo has those found last. So does the residual: it is
    momentum that the solution lacks, and the next solve finds it with its own.

    :param state: how the state is stored
    :param families: of the edges in the system; None takes those the scene models
    :param tolerance: sqrt((r, B r)), r the residual and B the preconditioner, over the change of
        velocity in the step: about the error of dv in the norm of the matrix, which bounds it
    :param foresees_turn: let the right side allow for how much longer edges get by turning
    """

    def __init__(
            self, scene: Scene, state: Layout, *, families: tuple[str, ...] | None = None,
            preconditioner: str = 'multigrid', tolerance: float, max_iterations: int,
            foresees_turn: bool = False) -> None:
        """Compile the passes and allocate the buffers."""
        if families is None:
            families = tuple(family for family in FAMILIES if scene.models(family))
        kind = PRECONDITIONERS[preconditioner]
        self._node_mass = scene.node_mass
        self._cloth = state
        levels = Levels(
            state, coarsen=kind.is_multigrid, has_bend='bend' in families,
            has_rigidity=scene.has_rigidity, has_bending_damping=scene.has_bending_damping,
            has_contact=scene.has_contact, has_surface=bool(scene.thin_colliders))
        self._programs = SolverPrograms(
            state, levels, families, is_multigrid=kind.is_multigrid,
            has_rigidity=scene.has_rigidity, has_bending_damping=scene.has_bending_damping,
            has_contact=scene.has_contact, has_cells=scene.cells is not None,
            has_surface=bool(scene.thin_colliders))
        self._damps_bending = scene.has_bending_damping
        self._has_low_parts = needs_low_parts(scene)
        parts = scene, state, self._programs, levels
        self._surface = (
            SolverSurface(*parts, sum_at=levels.sum_count) if scene.thin_colliders else None)
        self._right_side = RightSide(*parts, foresees_turn=foresees_turn)
        self._search = LimitSearch(
            *parts, foresees_turn=foresees_turn, surface=self._surface)
        self._held = HeldPass(*parts)
        self._tally = Tally(self._programs)
        self._contacts = SolverContacts(
            scene, state, self._programs, levels.cloth.node_groups,
            levels.cloth.groups, self._surface) if scene.has_contact else None
        self._preconditioner = kind(self._programs, levels, self._surface)
        self._iterations = Iterations(
            state, levels, self._programs, self._preconditioner, max_iterations, self._surface)
        self._buffers = self._iterations.buffers
        self._tolerance = tolerance
        self._last_law: EdgeLaw | None = None
        self._has_bend = 'bend' in families
        # One over the length of the step whose change the next one begins with; 0 for none.
        self._last_rate = 0.0
        self._start = Start(CHANGE, 0.0)
        self._is_further = self._is_again = self._may_stop_early = False
        self._is_cut_short = False
        # Where the residual of the last solve is; None where there is none to take over.
        self._left_in: int | None = None
        self._left_share = 0.0
        self._compile(levels)

    def set_law(self, law: EdgeLaw) -> None:
        """Take the weights of the edges and the length of the step from ``law``."""
        if law != self._last_law:
            self._last_law = law
            self._programs.set_law(law)
            self._preconditioner.set_law(law)

    @property
    def _share_of_change(self) -> float:
        """Return the share of CHANGE that the first pass of a step starts with."""
        # Where nothing is known, meet_colliders leaves there what nodes that touch begin with.
        knows_change = self._contacts is None or self._last_rate > 0.0
        return self._law.length * self._last_rate if knows_change else 1.0

    @property
    def _share_in_contact(self) -> float:
        is_in_contact = self._surface is not None and self._surface.has_contacts
        return _IN_CONTACT if is_in_contact else 1.0

    @property
    def _law(self) -> EdgeLaw:
        assert self._last_law is not None  # set_law comes first
        return self._last_law

    def meet_colliders(self, state: State, forcing: Forcing, kick: float) -> None:
        """
        Begin a substep of a scene with colliders: find which nodes touch one.

        :param kick: that ``forcing`` acts for [s]
        """
        assert self._contacts is not None
        length = self._law.length
        self._buffers.bind()
        self._contacts.begin(state, forcing, length, kick, length * self._last_rate)

    def resolve_contacts(
            self, state: State, forcing: Forcing, *, is_last: bool = False,
            ends_turns: bool = False, held_at: int = -1) -> None:
        """
        Let colliders act on a solution that was applied; what touches them may change.

        :param is_last: True to end the substep, once no further solve is due
        :param held_at: where its entries of held.glsl are; below 0: nowhere
        """
        assert self._contacts is not None
        self._buffers.bind()
        self._contacts.after_solve(
            state, forcing, self._law.length, is_last=is_last, ends_turns=ends_turns,
            left_share=self._left_share, held_at=held_at)

    def prepare(
            self, state: State, forcing: Forcing, *, kick: float | None = None,
            is_further: bool = False, is_again: bool = False,
            may_stop_early: bool = False, is_driven: bool = False) -> bool:
        """
        Make system and right side, and prepare the preconditioner.

        Return False, and prepare nothing, where a further solve would only correct rounding.

        :param forcing: what accelerates the nodes besides the edges
        :param kick: that it acts for [s]; the length of the step when None
        :param is_further: True after ``apply``: the solve finds what the tensions lack where
            nodes have come to
        :param is_again: True after ``move_start``: the same solve, with the limits in force that
            it has led to
        :param is_driven: whether it includes impulses of layers of the cloth, which are bound
        :param may_stop_early: True where ``move_start`` is asked for another solve after this one
        """
        length = self._law.length
        kick = length if kick is None else kick
        self._buffers.bind()
        state.bind_in()
        self._is_further = is_further
        if is_again:
            self._tally.add(self._tolerance, is_final=False)
        else:
            self._take_over()
        self._buffers.clear_scalars(keep_scale=is_further or is_again)
        # What changes the velocities changes little from step to step, and so do tensions.
        self._start = Start(START, 1.0) if is_again else Start(
            CHANGE, 0.0 if is_further else self._share_of_change,
            judges_by_tension=self._law.has_limits and self._last_rate > 0.0)
        if self._last_rate == 0.0 and not (is_further or is_again):
            self._find_first_tensions(forcing, kick)
        self._right_side.run(
            self._law, forcing, kick, self._start, is_further=is_further, is_driven=is_driven)
        if is_further and not (
                is_again or is_driven or self._is_touched(forcing) or self._buffers.is_off()):
            self._left_in = LEFT if self._left_share else None
            return False
        if self._contacts is not None:
            self._contacts.hold()
            if self._surface is not None:
                self._surface.weigh(state, forcing, self._law, self._start)
        if self._damps_bending and not is_further:
            self._damp.run()
        self._assembly.run()
        if not is_again:
            self._may_stop_early = may_stop_early and self._law.has_limits
        elif self._search.last_share < _HALF:
            self._may_stop_early = False
        self._iterations.start_from(self._start, self._left_share)
        self._iterations.stop_at(
            _AIM * self._tolerance * self._share_in_contact, may_stay=is_again,
            least_scale=None if is_further or is_again else least_scale(state, forcing, kick),
            early=_EARLY if self._may_stop_early else 0.0)
        self._is_again = is_again
        return True

    def _is_touched(self, forcing: Forcing) -> bool:
        return self._contacts is not None and self._contacts.is_touched(forcing)

    def set_right_side(self, values: np.ndarray) -> None:
        """
        Take (rows, cols, 3) ``values`` as b over the node mass [m/s], and nothing that was left.

        :param values: zero at pinned nodes
        """
        self._buffers.write(RESIDUAL, values)
        self._iterations.start_from(self._start, 0.0)

    def right_side(self) -> np.ndarray:
        """Return b over the node mass [m/s], (rows, cols, 3); ``solve`` uses it up."""
        return self._buffers.read(RESIDUAL)

    def solve(self) -> None:
        """Find the solution and the tensions; returns before the device has them."""
        self.iterate(never)
        self.find_tensions()

    def iterate(self, stop: Stop) -> None:
        """Find the solution alone; raise StepAbandoned where ``stop`` asks for it in between."""
        self._iterations.solve(stop)

    def record_held(
            self, state: State, forcing: Forcing, kick: float, held_at: int, *,
            is_further: bool = False) -> None:
        """Record what a solution drives pins with, before find_tensions, where held_at >= 0."""
        if held_at < 0:
            return
        assert state.impulses is not None  # it has given held_at
        self._buffers.bind()
        state.bind_in()
        state.impulses.bind(bindings.SOLVER_HELD)
        self._held.run(self._law, forcing, kick, held_at, is_further=is_further)

    def find_tensions(self) -> None:
        """Find the tensions of edges from the solution; later steps use them."""
        self._buffers.bind()
        self._tally.add(self._tolerance, is_final=True)
        self._find.run()
        self._left_in = None if self._is_cut_short else RESIDUAL
        self._last_rate = 1.0 / self._law.length

    def move_start(self, state: State, *, is_last: bool = False) -> bool:
        """
        Return whether another solve is due, to ``prepare`` with ``is_again``.

        Limits or contacts with thin colliders have come into force then, or out of it, or the last
        solve was stopped early.

        :param is_last: True to take where it would start for the solution
        """
        is_in_contact = self._surface is not None and self._surface.has_contacts
        if not (self._law.has_limits or is_in_contact):
            return False
        found = self._buffers.scalars()
        allowed = (_AIM * self._tolerance * self._share_in_contact)**2 * found.scale
        # Where it began is the solution, by the law as it is there.
        if self._is_again and found.measure_start <= allowed:
            return False
        is_early = allowed < found.measure_after <= _EARLY**2 * found.measure_start
        missing = (_LACKING * self._tolerance * self._share_in_contact)**2 * found.scale
        self._buffers.bind()
        state.bind_in()
        is_due = self._search.move_start(
            state, self._law, self._start, self._buffers, missing, SOLUTION if is_last else START,
            is_further=self._is_further, is_early=is_early)
        self._is_cut_short = is_due and is_last
        return is_due

    def apply(
            self, state: State, *, further: bool = False,
            common_change: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> None:
        """
        Add the solution to the velocities and move the nodes for the length of the step.

        :param further: True after a further ``prepare``: the nodes have moved before
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
        self._iterations.multiply.run()
        return self._buffers.read(PRODUCT)

    def solution(self) -> np.ndarray:
        """Return dv [m/s], (rows, cols, 3) float32."""
        return self._buffers.read(SOLUTION)

    def tensions(self) -> np.ndarray:
        """Return the tension of every edge [N], (rows, cols, 6) float32 as in Snapshot."""
        found = np.zeros((self._cloth.rows, self._cloth.cols, len(EDGE_KINDS)), dtype=np.float32)
        found[..., :4] = self._buffers.read_system(TENSION)
        if self._has_bend:
            found[..., 4:] = self._buffers.read_system(BEND_TENSION)[..., :2]
        return np.float32(self._node_mass) * found

    def run_search(self, state: State) -> None:
        """Run what ``move_start`` may need, after a solve, so that the driver compiles it."""
        self._buffers.bind()
        state.bind_in()
        self._search.run_all_passes(state, self._law, self._start, self._buffers, START)

    def expect_nothing(self) -> None:
        """Take no tension, change of velocity or residual over from earlier steps."""
        self._last_rate = 0.0
        self._left_in = None
        if self._surface is not None:
            self._surface.forget()

    def forget(self) -> None:
        """Drop what earlier solves have left, also where they came to no numbers."""
        self._buffers.clear()
        self._tally.clear()
        self.expect_nothing()

    def clear_tally(self) -> None:
        """Begin to count solves anew."""
        self._tally.clear()

    def tally(self) -> TallyReport:
        """Return how the solves ended since then."""
        return self._tally.report()

    def report(self) -> SolveReport:
        """Return how the last solve ended."""
        found = self._buffers.scalars()
        return report_of(
            found.scale, found.measure_after, int(found.iterations), self._tolerance)

    def had_nothing_to_do(self) -> bool:
        """Return whether the last solve, the first of its pass, began within the tolerance."""
        return not self._is_again and self._iterations.made <= 1

    def measured_residual(self) -> float:
        """Return the residual as it was before the last iteration of the last solve."""
        found = self._buffers.scalars()
        return report_of(found.scale, found.measure, 0, self._tolerance).residual

    def delete(self) -> None:
        """Release buffers and programs."""
        self._buffers.delete()
        self._tally.delete()
        self._programs.delete()
        self._right_side.delete()
        self._search.delete()
        self._held.delete()
        if self._contacts is not None:
            self._contacts.delete()
        if self._surface is not None:
            self._surface.delete()

    def _take_over(self) -> None:
        """Add the residual of the pass before to the right side of this one."""
        self._is_cut_short = False
        self._left_share = float(self._left_in is not None)
        if self._left_in == RESIDUAL:
            self._buffers.copy(RESIDUAL, LEFT)

    def _find_first_tensions(self, forcing: Forcing, kick: float) -> None:
        """Set the tensions to those of the present lengths, before a step has found any."""
        self._buffers.write(SOLUTION, np.zeros((self._cloth.rows, self._cloth.cols, 3)))
        undamped = replace(self._law, damping=(0.0,) * len(self._law.damping))
        self._right_side.run(undamped, forcing, kick, Start(CHANGE, 0.0), is_further=True)
        self._find.run()

    def _compile(self, levels: Levels) -> None:
        cloth, programs = levels.cloth, self._programs
        nodes = cloth.node_groups
        # What follows does not need the blocks of the cloth inverted.
        first, *others = self._preconditioner.assembly or [[]]
        self._assembly = PassList((
            [SolverPass(programs.make('assemble.comp'), nodes), *first], *others))
        if self._damps_bending:
            self._damp = SolverPass(programs.make('damp_bending.comp'), nodes)
        self._find = SolverPass(programs.make('find_tension.comp'), cloth.groups)
        self._apply = SolverPass(
            programs.make('apply.comp', HAS_LOW_PARTS=int(self._has_low_parts)), nodes)
