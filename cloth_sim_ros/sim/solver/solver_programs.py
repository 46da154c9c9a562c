# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Compile the programs of the solver: for the families of edges it takes, on its levels."""

from collections.abc import Collection

from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.gl.shader_source import ShaderSource
from cloth_sim_ros.sim.edge_kinds import edge_defines
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.levels import Levels
from cloth_sim_ros.sim.solver.smoothing_steps import smoothing_steps

POINT_LOCAL = 32
# Entries of one invocation where entries stand alone.
POINTS = 8
REDUCE_LOCAL = 16


class SolverPrograms:
    """
    What all programs of one solver share.

    :param state: how the state is stored
    :param families: of the edges in the system
    :param has_rigidity: whether bending is in it
    :param has_bending_damping: whether bending is damped
    :param has_contact: whether nodes can touch something
    """

    def __init__(
            self, state: Layout, levels: Levels, families: Collection[str], *,
            is_multigrid: bool, has_rigidity: bool, has_bending_damping: bool,
            has_contact: bool = False) -> None:
        """Gather the choices made at compile time."""
        self.defines = solver_defines(
            state, levels, families, is_multigrid=is_multigrid, has_rigidity=has_rigidity,
            has_bending_damping=has_bending_damping, has_contact=has_contact)
        self._state = state
        self._levels = levels
        self._is_multigrid = is_multigrid
        self._compiled: list[Program] = []

    def make(self, name: str, **defines: object) -> Program:
        """Return shaders/solver/``name``, compiled, in use and with its levels set."""
        program = Program(ShaderSource(f'solver/{name}', {**self.defines, **defines}))
        self._compiled.append(program)
        program.use()
        self.set_sizes(program)
        return program

    def delete(self) -> None:
        """Give all programs back."""
        for program in self._compiled:
            program.delete()
        self._compiled.clear()

    def set_sizes(self, program: Program) -> None:
        """Set the sizes of the lattices in the program in use."""
        self._levels.set_in(program)
        program.set_int('state_pitch', self._state.pitch)

    def set_law(self, law: EdgeLaw) -> None:
        """Set the weights of the edges in all programs."""
        steps = smoothing_steps(law) if self._is_multigrid else (1.0, 1.0)
        for program in self._compiled:
            program.use()
            program.set_float('first_step', steps[0])
            program.set_float('second_step', steps[1])
            program.set_float('substep', law.length)
            program.set_floats('bending_weight', law.bending_weights)
            program.set_floats('damping_weight', law.damping_weights)
            program.set_floats('bending_bound', law.bending_bounds)


def solver_defines(
        state: Layout, levels: Levels, families: Collection[str], *,
        is_multigrid: bool, has_rigidity: bool,
        has_bending_damping: bool = False, has_contact: bool = False) -> dict[str, object]:
    """Return what every shader of the solver compiles in."""
    return {
        **levels.cloth.defines(),
        **edge_defines(families),
        'MULTIGRID': int(is_multigrid),
        'HAS_RIGIDITY': int(has_rigidity),
        'HAS_BENDING_DAMPING': int(has_bending_damping),
        'HAS_CONTACT': int(has_contact),
        'BLOCKS_IN_LINE': int(state.texture_loads),
        'SUMS_BY_GROUP': int(not state.texture_loads),
        'POINT_LOCAL': POINT_LOCAL,
        'POINTS': POINTS,
        'REDUCE_LOCAL': REDUCE_LOCAL,
    }
