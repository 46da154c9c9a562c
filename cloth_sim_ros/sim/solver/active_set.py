# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The solves of a substep: how each begins, and which limits and contacts are in force."""

from dataclasses import dataclass
from dataclasses import replace

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_dispatches_visible
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.gl.quick_calls import make
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.forcing import touch_of
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import set_law
from cloth_sim_ros.sim.solver.solver_buffers import Levels
from cloth_sim_ros.sim.solver.solver_buffers import SolverBuffers
from cloth_sim_ros.sim.solver.solver_programs import POINT_LOCAL
from cloth_sim_ros.sim.solver.solver_programs import POINTS
from cloth_sim_ros.sim.solver.solver_programs import SolverPass
from cloth_sim_ros.sim.solver.solver_programs import SolverPrograms
from cloth_sim_ros.sim.solver.start import Start
from cloth_sim_ros.sim.solver.surface_contacts import SolverSurface
from cloth_sim_ros.sim.state import State
import numpy as np

# Looks of a line search [1], by false position, not nearer than a tenth to the ends of what is
# left; chosen: same bits from 6 to 12, 1 moves nodes by 1 % (constants.py --only _LOOKS).
_LOOKS = 6
# Slope where the next solve starts, over that at the start of this one [1]; chosen: nodes move by
# 2 % of their way from 0.01 to 0.5, solves by 1 % (constants.py --only _FLAT).
_FLAT = 0.05
# Way of a node by a contact that needs no further solve, over the spacing [1]; chosen: nodes move
# by 3 to 7 % of their way from 1e-6 to 1e-2, by half the tolerance 3 %; solves go from +105 % at
# 1e-6 to -20 % at 1e-2 (constants.py --only _MOST_UNSOLVED).
_MOST_UNSOLVED = 1e-4
# Workgroups along x, y and z, and number, of the nodes that near.comp lists.
_NONE_LISTED = np.array([0, 1, 1, 0], dtype=np.uint32)
# Room for each node in the list [bytes].
_LISTED_BYTES = 4


class RightSide:
    """
    Runs right_side.comp, for the first solve of a step and for further ones.

    :param foresees_turn: allow for how much longer edges get by turning
    """

    def __init__(
            self, scene: Scene, state: Layout, programs: SolverPrograms, levels: Levels, *,
            foresees_turn: bool) -> None:
        """Prepare; nothing is compiled yet."""
        self._has_layers: bool = scene['self_contact.enabled']
        self._program = SceneProgram('solver/right_side.comp', scene, state, {
            **programs.defines, 'FORESEES_TURN': int(foresees_turn),
            'HAS_LAYERS': int(self._has_layers)})
        self._programs = programs
        self._groups = levels.cloth.groups
        self._law_in: EdgeLaw | None = None

    def run(
            self, law: EdgeLaw, forcing: Forcing, kick: float, start: Start, *,
            is_further: bool, is_driven: bool = False) -> None:
        """
        Make the right side of the state that is bound.

        :param kick: that what is applied acts for [s]
        :param start: change of velocity to expect
        :param is_further: True where the nodes have moved, and tensions have been found
        :param is_driven: whether it includes impulses of layers, which are bound
        """
        program = self._program.use_for_step(forcing, law.length, kick)
        if self._law_in != law:
            self._programs.set_sizes(program)
            set_law(program, law)
            program.set_float('geometric', law.geometric)
            self._law_in = law
        start.set_in(program)
        program.set_float('to_come', float(not is_further))
        if self._has_layers:
            program.set_float('driven_share', float(is_driven))
        program.dispatch(*self._groups)
        shader_writes_visible()

    def delete(self) -> None:
        """Free the program."""
        self._program.delete()


class HeldPass:
    """Runs held.comp: what a solve drives pinned nodes with."""

    def __init__(
            self, scene: Scene, state: Layout, programs: SolverPrograms, levels: Levels) -> None:
        """Prepare; nothing is compiled yet."""
        self._program = SceneProgram('solver/held.comp', scene, state, {
            **programs.defines, 'BLOCK': 1, 'HELD_BINDING': bindings.SOLVER_HELD})
        self._programs = programs
        # Few nodes are pinned: a block of one is compiled in a tenth of the time.
        self._groups = replace(levels.cloth, block=1).groups
        self._law_in: EdgeLaw | None = None

    def run(
            self, law: EdgeLaw, forcing: Forcing, kick: float, held_at: int, *,
            is_further: bool) -> None:
        """
        Leave it at ``held_at``; as RightSide.run, after the solve.

        :param is_further: True to add to what the solves before it have left
        """
        program = self._program.use_for_step(forcing, law.length, kick)
        if self._law_in != law:
            self._programs.set_sizes(program)
            set_law(program, law)
            program.set_floats('damping_weight', law.damping_weights)
            self._law_in = law
        program.set_float('to_come', float(not is_further))
        program.set_int('held_at', held_at)
        program.dispatch(*self._groups)
        shader_writes_visible()

    def delete(self) -> None:
        """Release the program."""
        self._program.delete()


# Whether a solve has found the limits in force, and where the next one starts if not.
#
# A solve takes the law of each edge for a straight line. Where edges come to limits or leave them,
# its solution may be worse than its start. What the step minimises is convex, so its slope along
# the way from start to solution changes sign once: there the next solve starts, which so comes
# nearer (Newton's method with a line search; docs/explanation/adaptive.md). That is sure from the
# second solve of a pass on: the first takes its lines where tensions say, not where it starts.


@dataclass(frozen=True)
class _Look:
    """
    What a look at some share of the way has found.

    :param curvature: along the way, of the straight law
    :param more: slope that the true law has besides
    :param missing: square of what tensions lack
    """

    curvature: float
    more: float
    missing: float

    def slope(self, share: float) -> float:
        """Return the slope over that at the start, below 0 where it goes down."""
        return share - 1.0 + self.more / self.curvature


class LimitSearch:
    """
    Runs limit_search.comp and start_between.comp; nothing is compiled before that.

    ``last_share`` is that of the way of the last solve after which the next one starts.

    :param foresees_turn: as of RightSide
    :param surface: contacts of edges and faces; None where there can be none
    """

    def __init__(
            self, scene: Scene, state: Layout, programs: SolverPrograms, levels: Levels, *,
            foresees_turn: bool, surface: SolverSurface | None = None) -> None:
        """Prepare."""
        self._surface = surface
        # In a further solve it makes no difference, with velocities of 0.
        defines = {**programs.defines, 'FORESEES_TURN': int(foresees_turn)}
        self._look_at = SceneProgram('solver/limit_search.comp', scene, state, defines)
        self._move = SceneProgram('solver/start_between.comp', scene, state, defines)
        self._programs = programs
        self._groups = levels.cloth.groups
        self._points = -(-levels.cloth.stored // (POINTS * POINT_LOCAL))
        self._law_in: EdgeLaw | None = None
        self.last_share = 1.0

    def run_all_passes(
            self, state: State, law: EdgeLaw, start: Start, buffers: SolverBuffers,
            into: int) -> None:
        """Run both passes once, so that the driver compiles them; as ``move_start``."""
        self._set(law, start, is_further=False)
        self._look(state, 1.0, start, buffers, is_first=True)
        self._start_between(1.0, start, into)

    def delete(self) -> None:
        """Release both programs."""
        self._look_at.delete()
        self._move.delete()

    def move_start(
            self, state: State, law: EdgeLaw, start: Start, buffers: SolverBuffers,
            missing: float, into: int, *, is_further: bool, is_early: bool = False) -> bool:
        """
        Leave in a field where the next solve starts; return False where none is needed.

        :param start: of the last solve
        :param missing: of the square of what tensions lack, that may be left
        :param into: the field, of SolverBuffers
        :param is_further: as of RightSide
        :param is_early: whether another solve is due in any case
        """
        self._set(law, start, is_further=is_further)
        share = 1.0
        look = self._look(state, share, start, buffers, is_first=True)
        # Written so that NaN is not looked at again. Where nothing moves and nothing
        # is applied there is no way to go.
        if not ((is_early or look.missing > missing) and look.curvature > 0.0):
            return False
        low, high = 0.0, 1.0
        low_slope, high_slope = -1.0, min(look.slope(1.0), 1.0)
        if high_slope > _FLAT:
            for _ in range(_LOOKS):
                share = low - low_slope * (high - low) / (high_slope - low_slope)
                share = min(max(share, low + 0.1 * (high - low)), high - 0.1 * (high - low))
                slope = self._look(state, share, start, buffers).slope(share)
                if abs(slope) <= _FLAT:
                    break
                if slope < 0.0:
                    low, low_slope = share, slope
                else:
                    high, high_slope = share, slope
                # Limits that come into force near its end make the slope there many times as
                # steep: false position would look near the start alone.
                high_slope = min(high_slope, -low_slope)
        self.last_share = share
        self._start_between(share, start, into)
        return True

    def _set(self, law: EdgeLaw, start: Start, *, is_further: bool) -> None:
        program = self._look_at.use()
        if self._law_in != law:
            self._programs.set_sizes(program)
            program.set_float('substep', law.length)
            set_law(program, law)
            self._law_in = law
        program.set_float('to_come', float(not is_further))
        start.set_in(program)

    def _look(
            self, state: State, share: float, start: Start, buffers: SolverBuffers, *,
            is_first: bool = False) -> _Look:
        # Without limits, edges have the same sums everywhere.
        if is_first or (self._law_in is not None and self._law_in.has_limits):
            program = self._look_at.use()
            program.set_float('share', share)
            program.dispatch(*self._groups)
            shader_writes_visible()
        is_in_contact = self._surface is not None and self._surface.has_contacts
        if self._surface is not None and is_in_contact:
            self._surface.look(state, share, start)
        return _Look(*buffers.sums(with_surface=is_in_contact))

    def _start_between(self, share: float, start: Start, into: int) -> None:
        program = self._move.use()
        self._programs.set_sizes(program)
        start.set_in(program)
        program.set_float('share', share)
        program.set_int('into', into)
        program.dispatch(self._points, 1)
        shader_writes_visible()


# Which nodes touch a collider in a substep of the implicit step, docs/explanation/contact.md.


class SolverContacts:
    """
    Makes velocities right where colliders decide about them, before and after each solve.

    The solver's buffers have to be bound.

    :param groups: workgroups of passes with one node an invocation
    :param block_groups: workgroups of those with a block of nodes
    :param surface: contacts of edges and faces; None where there can be none
    """

    def __init__(
            self, scene: Scene, state: Layout, programs: SolverPrograms,
            groups: tuple[int, int], block_groups: tuple[int, int],
            surface: SolverSurface | None) -> None:
        """Compile the passes of each solve; the others are compiled when first needed."""
        self._programs = programs
        self._groups = groups
        self._surface = surface
        self._most_unsolved = _MOST_UNSOLVED * min(scene.spacing)
        # Thin colliders act by SolverSurface alone.
        others = {} if surface is None else {
            'NODE_COLLIDERS': f'{surface.bits ^ 0xffffffff}u'}
        self._decide = {
            stage: SceneProgram('solver/contact.comp', scene, state, {
                **programs.defines, **others, 'STAGE': stage})
            for stage in ('BEGIN', 'AGAIN', 'END')}
        # List those that BEGIN, and that AGAIN and END, decide about.
        self._near = {
            stage: SceneProgram('solver/near.comp', scene, state, {
                **programs.defines, **others, 'STAGE': stage}) for stage in ('BEGIN', 'AFTER')}
        self._listed = Buffer(_NONE_LISTED.nbytes + _LISTED_BYTES * scene.node_count)
        self._clear_listed = self._listed.write_calls(_NONE_LISTED)
        self._hold = programs.make('hold.comp')
        self._react = SolverPass(programs.make('reaction.comp'), block_groups)

    def begin(
            self, state: State, forcing: Forcing, length: float, kick: float,
            guess: float) -> None:
        """
        Decide what touches in a substep of ``length`` [s] that begins with ``state``.

        :param kick: that ``forcing`` acts for [s]
        :param guess: share of the last change of velocity that is expected; 0 where none is known
        """
        near = self._near['BEGIN'].use_for_step(forcing, length, kick)
        near.set_float('guess', guess)
        self._list_near(near, state, forcing, length)
        program = self._use('BEGIN', forcing, length, kick)
        program.set_float('guess', guess)
        self._write_listed(program, state)
        state.swap()
        if self._surface is not None:
            self._surface.begin(state, forcing, length, kick, guess)

    def is_touched(self, forcing: Forcing) -> bool:
        """Return whether a node, edge or face has touched a collider in the substep."""
        return (self._surface is not None and self._surface.has_contacts) or (
            touch_of(forcing).is_touched())

    def hold(self) -> None:
        """Take from a right side what nodes that touch a collider can't follow."""
        self._hold.use()
        self._run_listed(self._hold)

    def after_solve(
            self, state: State, forcing: Forcing, length: float, *, is_last: bool,
            ends_turns: bool, left_share: float, held_at: int) -> None:
        """
        Decide anew once a solve is applied; once more with ``is_last`` to end the substep.

        :param held_at: where entries of held.glsl are; below 0: nowhere
        :param left_share: of the residual of the solve before it, that the solve has taken over
        """
        if not is_last:
            self._react.set_float('left_share', left_share)
            self._react.run()
        touch_of(forcing).begin_decision()
        if self._surface is not None and not is_last:
            self._surface.give(state, forcing, length)
        # END decides about the nodes that were listed after the last solve.
        if not is_last:
            near = self._near['AFTER'].use_for_step(forcing, length)
            near.set_float('most_unsolved', self._most_unsolved)
            self._list_near(near, state, forcing, length)
        program = self._use('END' if is_last else 'AGAIN', forcing, length, length)
        program.set_int('ends_turns', int(ends_turns))
        self._write_listed(program, state)
        if is_last and self._surface is not None and self._surface.has_contacts:
            self._surface.record(state, forcing, length, held_at)
            touch_of(forcing).move_out(state, length)
        state.swap()
        if self._surface is not None and not is_last:
            self._surface.find_again(state, forcing, length)

    def delete(self) -> None:
        """Release the passes."""
        for program in (*self._decide.values(), *self._near.values()):
            program.delete()
        self._listed.delete()

    def _use(self, stage: str, forcing: Forcing, length: float, kick: float) -> Program:
        program = self._decide[stage].use_for_step(forcing, length, kick)
        self._set(program, forcing, length)
        return program

    def _set(self, program: Program, forcing: Forcing, length: float) -> None:
        self._programs.set_sizes(program)
        program.set_float('most_unsolved', self._most_unsolved)
        touch_of(forcing).set_in(program, length)

    def _list_near(
            self, program: Program, state: State, forcing: Forcing, length: float) -> None:
        make(self._clear_listed)
        self._programs.set_sizes(program)
        touch_of(forcing).set_in(program, length)
        self._listed.bind_storage(bindings.SOLVER_NEAR)
        state.bind_in()
        program.dispatch(*self._groups)
        shader_dispatches_visible()

    def _write_listed(self, program: Program, state: State) -> None:
        state.carry_over()
        state.bind_in()
        state.bind_out()
        self._run_listed(program)

    def _run_listed(self, program: Program) -> None:
        self._listed.bind_storage(bindings.SOLVER_NEAR)
        self._listed.bind_dispatches()
        program.dispatch_indirect(0)
        shader_writes_visible()
