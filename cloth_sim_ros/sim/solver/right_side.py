# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a solve begins with: the right side, and how much each edge resists."""

from dataclasses import dataclass

from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_program import SceneProgram
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import set_law
from cloth_sim_ros.sim.solver.levels import Levels
from cloth_sim_ros.sim.solver.solver_programs import SolverPrograms


@dataclass(frozen=True)
class Start:
    """
    Where a solve starts.

    :param field: of SolverBuffers, a change of velocity
    :param share: of it
    """

    field: int
    share: float

    def set_in(self, program: Program) -> None:
        """Set it in the program in use."""
        program.set_int('start_field', self.field)
        program.set_float('guess', self.share)


class RightSide:
    """
    Runs right_side.comp, for the first solve of a step or for a further one.

    :param foresees_turn: allow for how much longer edges get by turning
    """

    def __init__(
            self, scene: Scene, state: Layout, programs: SolverPrograms, levels: Levels, *,
            is_further: bool, foresees_turn: bool) -> None:
        """Prepare; nothing is compiled yet."""
        self._program = SceneProgram('solver/right_side.comp', scene, state, {
            **programs.defines, 'FORESEES_TURN': int(foresees_turn),
            'IS_FURTHER': int(is_further)})
        self._programs = programs
        self._groups = levels.cloth.groups
        self._law_in: EdgeLaw | None = None

    def run(
            self, law: EdgeLaw, forcing: Forcing, kick: float, start: Start, *,
            knows_tension: bool) -> None:
        """
        Make the right side of the state that is bound.

        :param kick: that what is applied acts for [s]
        :param start: change of velocity to expect
        :param knows_tension: False where no step before has found the tensions
        """
        program = self._program.use_for_step(forcing, law.length, kick)
        if self._law_in != law:
            self._programs.set_sizes(program)
            set_law(program, law)
            program.set_float('geometric', law.geometric)
            self._law_in = law
        start.set_in(program)
        program.set_int('knows_tension', int(knows_tension))
        program.dispatch(*self._groups)
        shader_writes_visible()

    def delete(self) -> None:
        """Give the program back."""
        self._program.delete()
