# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which nodes touch a collider in a substep of the implicit step, docs/explanation/contact.md."""

from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.forcing import touch_of
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_program import SceneProgram
from cloth_sim_ros.sim.solver.solver_pass import SolverPass
from cloth_sim_ros.sim.solver.solver_programs import SolverPrograms
from cloth_sim_ros.sim.state import State

# Of the distance of nodes: what one may be moved by without another solve.
_MOST_UNSOLVED = 1e-4


class SolverContacts:
    """
    Makes velocities right where colliders decide about them, before and after each solve.

    The solver's buffers have to be bound.

    :param groups: workgroups of passes with one node an invocation
    :param block_groups: workgroups of those with a block of nodes
    """

    def __init__(
            self, scene: Scene, state: Layout, programs: SolverPrograms,
            groups: tuple[int, int], block_groups: tuple[int, int]) -> None:
        """Compile the passes of each solve; the others are compiled when first needed."""
        self._programs = programs
        self._groups = groups
        self._most_unsolved = _MOST_UNSOLVED * min(scene.spacing)
        self._decide = {
            stage: SceneProgram('solver/contact.comp', scene, state, {
                **programs.defines, 'STAGE': stage}) for stage in ('BEGIN', 'AGAIN', 'END')}
        self._hold = SolverPass(programs.make('hold.comp'), groups)
        self._react = SolverPass(programs.make('reaction.comp'), block_groups)

    def begin(
            self, state: State, forcing: Forcing, length: float, kick: float,
            guess: float) -> None:
        """
        Decide what touches in a substep of ``length`` [s] that begins with ``state``.

        :param kick: that ``forcing`` acts for [s]
        :param guess: share of the last change of velocity that is expected; 0 where none is known
        """
        program = self._use('BEGIN', forcing, length, kick)
        program.set_float('guess', guess)
        program.set_float('most_unsolved', self._most_unsolved)
        self._run(program, state)

    def hold(self) -> None:
        """Take from a right side what nodes that touch a collider can't follow."""
        self._hold.run()

    def after_solve(
            self, state: State, forcing: Forcing, length: float, *, is_last: bool,
            ends_turns: bool) -> None:
        """Decide anew once a solve is applied; once more with ``is_last`` to end the substep."""
        if not is_last:
            self._react.run()
        touch_of(forcing).begin_decision()
        program = self._use('END' if is_last else 'AGAIN', forcing, length, length)
        program.set_float('most_unsolved', self._most_unsolved)
        program.set_int('ends_turns', int(ends_turns))
        self._run(program, state)

    def delete(self) -> None:
        """Give the passes back."""
        for program in self._decide.values():
            program.delete()

    def _use(self, stage: str, forcing: Forcing, length: float, kick: float) -> Program:
        program = self._decide[stage].use_for_step(forcing, length, kick)
        self._programs.set_sizes(program)
        touch_of(forcing).set_in(program, length)
        return program

    def _run(self, program: Program, state: State) -> None:
        state.bind_in()
        state.bind_out()
        program.dispatch(*self._groups)
        shader_writes_visible()
        state.swap()
