# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The programs of the solver: for the edges it takes, on its levels, run as its passes."""

from collections.abc import Collection
from collections.abc import Iterable
from collections.abc import Sequence

from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.buffer import writes_visible_call
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.gl.quick_calls import Call
from cloth_sim_ros.gl.quick_calls import make
from cloth_sim_ros.gl.shader_source import ShaderSource
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.model.edge_kinds import edge_defines
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.solver_buffers import Levels

# Least eigenvalue that smoothing damps [1], the largest being 2 at most; what is below is left to
# coarser levels; chosen: iterations rise by 10 % at 1/16, 5 % at 1/8 and 2 % at 1
# (benchmarks/constants.py --only _LEAST).
_LEAST = 0.25
# Edges of each rest length around a node [1]; on coarse levels a bend edge counts with those of
# four nodes.
_EDGES_OF_A_NODE = (2.0, 2.0, 4.0, 8.0, 8.0)
# Sum of the squares of a node's parts in the three lines around it [1]: 1 + 2^2 + 1.
_LINES_OF_A_NODE = 6.0
# Invocations of a workgroup [1] of passes over single entries, and entries of each invocation.
POINT_LOCAL = 32
POINTS = 8
# Invocations of the workgroup of reduce.comp [1].
REDUCE_LOCAL = 16
# Invocations of the workgroup that goes through several levels [1], at least the nodes of the
# coarsest; not measured on a GPU yet: with so many, each can have 128 registers.
TOGETHER_LOCAL = 512
# Size of the workgroup counts of one dispatch [bytes]: three uint32.
_BYTES_PER_DISPATCH = 12


def smoothing_steps(law: EdgeLaw) -> tuple[float, float]:
    """
    Return the two Chebyshev steps, as shares of a whole step of block-Jacobi.

    They are made for the eigenvalues of the system over its diagonal blocks. With edges that
    weigh d around a node of mass 1 none is below 1 / (1 + d) nor, as an edge ties two nodes, above
    (1 + 2 d) / (1 + d). Bending of the weight b around a node has up to 3 b there, as it ties
    three nodes; out of the plane of the cloth it is alone. Without either both steps are whole
    ones, and the first is exact.

    Beyond the largest eigenvalue foreseen, smoothing makes errors grow and the preconditioner has
    negative eigenvalues: the solver would report small residuals and be wrong.
    """
    edges = sum(count * weight for count, weight in zip(_EDGES_OF_A_NODE, law.weights))
    bending = _LINES_OF_A_NODE * sum(law.bending_bounds)
    around = edges + bending
    least = max(_LEAST, 1.0 / (1.0 + around))
    most = max(
        (1.0 + 2.0 * edges + 3.0 * bending) / (1.0 + around),
        (1.0 + 3.0 * bending) / (1.0 + bending))
    middle, reach = 0.5 * (most + least), 0.5 * (most - least) * 0.5**0.5
    return 1.0 / (middle + reach), 1.0 / (middle - reach)


# Compile the programs of the solver: for the families of edges it takes, on its levels.

class SolverPrograms:
    """
    What all programs of one solver share.

    :param state: how the state is stored
    :param families: of the edges in the system
    :param has_rigidity: whether bending is in it
    :param has_bending_damping: whether bending is damped
    :param has_contact: whether nodes can touch something
    :param has_cells: whether the cloth is one of cells
    :param has_surface: whether edges and faces can touch something
    """

    def __init__(
            self, state: Layout, levels: Levels, families: Collection[str], *,
            is_multigrid: bool, has_rigidity: bool, has_bending_damping: bool,
            has_contact: bool = False, has_cells: bool = False,
            has_surface: bool = False) -> None:
        """Gather the choices made at compile time."""
        self.defines = solver_defines(
            state, levels, families, is_multigrid=is_multigrid, has_rigidity=has_rigidity,
            has_bending_damping=has_bending_damping, has_contact=has_contact,
            has_cells=has_cells, has_surface=has_surface)
        self._state = state
        self._levels = levels
        self._is_multigrid = is_multigrid
        self._compiled: list[Program] = []

    @property
    def has_few_dispatches(self) -> bool:
        """
        Return whether workgroups do one after another what could be dispatches of their own.

        On llvmpipe, where barriers cost much and dispatches little, a step of 64 x 64 nodes would
        take 2.4 times as long (docs/notes/performance.md).
        """
        return self._state.is_asynchronous

    def make(self, name: str, **defines: object) -> Program:
        """Return shaders/solver/``name``, compiled, in use and with its levels set."""
        program = Program(ShaderSource(f'solver/{name}', {**self.defines, **defines}))
        self._compiled.append(program)
        program.use()
        self.set_sizes(program)
        return program

    def delete(self) -> None:
        """Release all programs."""
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
        has_bending_damping: bool = False, has_contact: bool = False,
        has_cells: bool = False, has_surface: bool = False) -> dict[str, object]:
    """Return what every shader of the solver compiles in."""
    return {
        **levels.cloth.defines(),
        **levels.defines(),
        **edge_defines(families),
        'MULTIGRID': int(is_multigrid),
        'HAS_RIGIDITY': int(has_rigidity),
        'HAS_BENDING_DAMPING': int(has_bending_damping),
        'HAS_CONTACT': int(has_contact),
        'HAS_CELLS': int(has_cells),
        'HAS_SURFACE': int(has_surface),
        'BLOCKS_IN_LINE': int(state.texture_loads),
        'SUMS_BY_GROUP': int(not state.texture_loads),
        'POINT_LOCAL': POINT_LOCAL,
        'POINTS': POINTS,
        'REDUCE_LOCAL': REDUCE_LOCAL,
    }


# One pass of the solver, and the list of workgroup counts that reduce.comp switches off.

class SolverPass:
    """
    A program with the workgroups it always runs on.

    :param uniforms: of the program, an int or a bool each, that it has in this pass
    """

    def __init__(
            self, program: Program, groups: tuple[int, int], **uniforms: int) -> None:
        """Remember how to run ``program``."""
        self.groups = groups
        self._program = program
        self._uniforms = uniforms
        self._offset = 0

    def set_int(self, name: str, value: int) -> None:
        """Set an int uniform of the program."""
        self._program.use()
        self._program.set_int(name, value)

    def set_float(self, name: str, value: float) -> None:
        """Set a float uniform of the program."""
        self._program.use()
        self._program.set_float(name, value)

    def set_vectors(self, name: str, vectors: Sequence[float]) -> None:
        """Set a vec3 uniform of the program."""
        self._program.use()
        self._program.set_vectors(name, vectors)

    def switch(self, dispatches: list[tuple[int, int]]) -> None:
        """Take the pass's place in ``dispatches``, the workgroup counts that can be switched."""
        if self.groups not in dispatches:
            dispatches.append(self.groups)
        self._offset = dispatches.index(self.groups) * _BYTES_PER_DISPATCH

    def run(self) -> None:
        """Run the pass and order what follows after it."""
        self.run_beside()
        shader_writes_visible()

    def run_beside(self) -> None:
        """Run the pass beside those that follow until a barrier."""
        self._use()
        self._program.dispatch(*self.groups)

    def calls(self) -> list[Call]:
        """Return what runs the pass, without the barrier after it."""
        return self._program.calls(*self.groups, **self._uniforms)

    def calls_if_going(self) -> list[Call]:
        """Return what runs the pass unless the device has decided to stop, and the barrier."""
        return [
            *self._program.indirect_calls(self._offset, **self._uniforms), writes_visible_call()]

    def submitted(self, count: int) -> None:
        """Count ``count`` times that ``calls`` or ``calls_if_going`` were made."""
        self._program.submitted(count)

    def _use(self) -> None:
        self._program.use()
        for name, value in self._uniforms.items():
            self._program.set_int(name, value)


class PassList:
    """
    Passes that always follow one another, with nothing in between.

    :param stages: of passes that do not need each other, so that one barrier is after all of them
    """

    def __init__(self, stages: Iterable[Sequence[SolverPass]]) -> None:
        """Prepare their calls."""
        stages = tuple(stages)
        self._passes = tuple(each for stage in stages for each in stage)
        self._calls = [call for stage in stages for call in (
            *(call for each in stage for call in each.calls()), writes_visible_call())]

    def run(self) -> None:
        """Run all of them."""
        make(self._calls)
        for each in self._passes:
            each.submitted(1)
