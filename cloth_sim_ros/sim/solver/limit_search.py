# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Whether a solve has found the limits in force, and where the next one starts if not.

A solve takes the law of each edge for a straight line. Where edges come to limits or leave them,
its solution may be worse than its start. What the step minimises is convex, so its slope along
the way from start to solution changes sign once: there the next solve starts, which so comes
nearer in any case (Newton's method with a line search; docs/explanation/implicit_step.md).
"""

from dataclasses import dataclass

from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_program import SceneProgram
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import set_law
from cloth_sim_ros.sim.solver.levels import Levels
from cloth_sim_ros.sim.solver.right_side import Start
from cloth_sim_ros.sim.solver.solver_buffers import SolverBuffers
from cloth_sim_ros.sim.solver.solver_programs import POINT_LOCAL
from cloth_sim_ros.sim.solver.solver_programs import POINTS
from cloth_sim_ros.sim.solver.solver_programs import SolverPrograms

# Looks along the way, by false position, not nearer than a tenth to the ends of what is left.
_LOOKS = 6
# Of the slope at the start: what the slope at the end of the way may be.
_FLAT = 0.05


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

    :param is_further: as of RightSide
    :param foresees_turn: as of RightSide
    """

    def __init__(
            self, scene: Scene, state: Layout, programs: SolverPrograms, levels: Levels, *,
            is_further: bool, foresees_turn: bool) -> None:
        """Prepare."""
        defines = {**programs.defines, 'FORESEES_TURN': int(foresees_turn),
                   'IS_FURTHER': int(is_further)}
        self._look_at = SceneProgram('solver/limit_search.comp', scene, state, defines)
        self._move = SceneProgram('solver/start_between.comp', scene, state, defines)
        self._programs = programs
        self._groups = levels.cloth.groups
        self._points = -(-levels.cloth.stored // (POINTS * POINT_LOCAL))
        self._law_in: EdgeLaw | None = None

    def prepare(self) -> None:
        """Compile both passes."""
        self._look_at.use()
        self._move.use()

    def delete(self) -> None:
        """Give both programs back."""
        self._look_at.delete()
        self._move.delete()

    def move_start(
            self, law: EdgeLaw, start: Start, buffers: SolverBuffers, missing: float,
            into: int) -> bool:
        """
        Leave in a field where the next solve starts; return False where none is needed.

        :param start: of the last solve
        :param missing: of the square of what tensions lack, that may be left
        :param into: the field, of SolverBuffers
        """
        self._set(law, start)
        share = 1.0
        look = self._look(share, buffers)
        # Written so that what is no number is not looked at again. Where nothing moves and nothing
        # is applied there is no way to go.
        if not (look.missing > missing and look.curvature > 0.0):
            return False
        low, high = 0.0, 1.0
        low_slope, high_slope = -1.0, look.slope(1.0)
        if high_slope > _FLAT:
            for _ in range(_LOOKS):
                share = low - low_slope * (high - low) / (high_slope - low_slope)
                share = min(max(share, low + 0.1 * (high - low)), high - 0.1 * (high - low))
                slope = self._look(share, buffers).slope(share)
                if abs(slope) <= _FLAT:
                    break
                if slope < 0.0:
                    low, low_slope = share, slope
                else:
                    high, high_slope = share, slope
        self._start_between(share, start, into)
        return True

    def _set(self, law: EdgeLaw, start: Start) -> None:
        program = self._look_at.use()
        if self._law_in != law:
            self._programs.set_sizes(program)
            program.set_float('substep', law.length)
            set_law(program, law)
            self._law_in = law
        start.set_in(program)

    def _look(self, share: float, buffers: SolverBuffers) -> _Look:
        program = self._look_at.use()
        program.set_float('share', share)
        program.dispatch(*self._groups)
        shader_writes_visible()
        return _Look(*buffers.sums())

    def _start_between(self, share: float, start: Start, into: int) -> None:
        program = self._move.use()
        self._programs.set_sizes(program)
        start.set_in(program)
        program.set_float('share', share)
        program.set_int('into', into)
        program.dispatch(self._points, 1)
        shader_writes_visible()
