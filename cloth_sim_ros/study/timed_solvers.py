# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The solvers that can be timed side by side, the paper's own among them."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any
from typing import Protocol

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.gl.shader_source import ShaderSource
from cloth_sim_ros.reference.edges import Edges
from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.sim.device.layout import choose_layout
from cloth_sim_ros.sim.device.low_parts import needs_low_parts
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import full_pull
from cloth_sim_ros.sim.solver.edge_law import hard_edges
from cloth_sim_ros.sim.solver.edge_law import spring_law
from cloth_sim_ros.sim.solver.solver import Solver
from cloth_sim_ros.sim.solver.tally import SolveReport
from cloth_sim_ros.sim.state import State
import numpy as np

# The paper's own solver, as a baseline: J J^T formed pair by pair, then plain conjugate gradients.
#
# Va et al. 2021, Tab. 3 to 6. Different from the print: unit rows, the inverse mass inside, and
# the same compliance as ``hard_edges``, without which the matrix is singular
# (docs/explanation/solver.md, The paper's solver).

_BUFFERS = ('EDGES', 'NODES', 'VALUES', 'COLUMNS', 'MATRIX', 'COUNTS', 'VECTORS', 'SCALARS')
_FAMILIES = ('structural', 'shear')
_VALUES = 6
# Entries of the matrix that are kept for a row: an edge meets 14 others and itself, with bend
# springs 22.
_ROW_SLOTS = {False: 16, True: 24}
_VECTORS = 4
_LAMBDA, _RESIDUAL, _DIRECTION, _IMAGE = range(_VECTORS)
_SCALARS = 4
_AT_START, _AFTER_PRODUCT, _AFTER_UPDATE = range(3)
_LOCAL = 1024
_PAIR_LOCAL = 16


class PaperSolver:
    """
    Solves (J W J^T + E / h^2) lambda = C / h^2 + J (v / h + g) for hard edges of one state.

    E is that of the scene, see ``full_pull``.

    :param positions: (rows, cols, 3) [m]
    :param velocities: (rows, cols, 3) [m/s]
    :param step: h [s]
    :param tolerance: norm of the residual over that at the start
    :param families: of the hard edges
    """

    def __init__(
            self, scene: Scene, positions: np.ndarray, velocities: np.ndarray, step: float, *,
            tolerance: float = 1e-2, max_iterations: int = 2000,
            families: Sequence[str] = _FAMILIES) -> None:
        """Compile the shaders and upload the state."""
        edges = edges_of(scene, families)
        free = ~scene.pinned_nodes().ravel()
        self._kept = edges.of(families) & (free[edges.first] | free[edges.second])
        self._edges = edges
        self._count = int(np.count_nonzero(self._kept))
        self._shape = positions.shape
        self._inverse_mass = free / (scene.node_mass * scene.node_shares.ravel())
        self._step = step
        self._acceleration = free[:, None] * np.asarray(scene['gravity'])
        self._positions = positions.reshape(-1, 3)
        self._tolerance = tolerance
        self._max_iterations = max_iterations
        self._iterations = 0
        self._groups = -(-self._count // _LOCAL)
        self._row_slots = _ROW_SLOTS['bend' in families]
        self._make_buffers(velocities.reshape(-1, 3))
        self._compile(scene)

    def set_state(self, positions: np.ndarray, velocities: np.ndarray) -> None:
        """Replace positions [m] and velocities [m/s], (rows, cols, 3)."""
        self._positions = positions.reshape(-1, 3)
        self._buffers['NODES'].write(self._node_entries(velocities.reshape(-1, 3)))

    def solve(self) -> None:
        """Form the matrix and find lambda; the host looks at the residual in each iteration."""
        for binding, buffer in enumerate(self._buffers.values()):
            buffer.bind_storage(binding)
        self._run('constraint')
        pairs = -(-self._count // _PAIR_LOCAL)
        self._run('spmm', groups=(pairs, pairs))
        self._sum(_RESIDUAL, _RESIDUAL, _AT_START)
        self._iterations = 0
        while self._iterations < self._max_iterations and self._residual() > self._tolerance:
            self._run('spmv')
            self._sum(_DIRECTION, _IMAGE, _AFTER_PRODUCT)
            self._run('update')
            self._sum(_RESIDUAL, _RESIDUAL, _AFTER_UPDATE)
            self._run('direction')
            self._iterations += 1

    def report(self) -> SolveReport:
        """Return how the last solve ended; its residual is the plain norm over the start's."""
        residual = self._residual()
        return SolveReport(self._iterations, residual, bool(residual <= self._tolerance))

    def tensions(self) -> np.ndarray:
        """Return lambda [N] of each edge between nodes that are not both pinned."""
        values = np.empty(self._count, dtype=np.float32)
        self._buffers['VECTORS'].read_into(values, _LAMBDA * values.nbytes)
        return values

    def solution(self) -> np.ndarray:
        """Return dv [m/s], (rows, cols, 3): gravity and tensions over the step."""
        tension = np.zeros(len(self._edges))
        tension[self._kept] = self.tensions()
        pull = self._edges.scatter(
            tension[:, None] * self._edges.directions(self._positions.astype(float)),
            len(self._positions))
        change = self._step * (self._acceleration - self._inverse_mass[:, None] * pull)
        return change.reshape(self._shape)

    def delete(self) -> None:
        """Free the buffers."""
        for buffer in self._buffers.values():
            buffer.delete()

    def _make_buffers(self, velocities: np.ndarray) -> None:
        def of(entries: int, kind: type = np.float32) -> np.ndarray:
            return np.zeros(entries, dtype=kind)

        nodes = self._node_entries(velocities)
        self._buffers = {name: Buffer(data) for name, data in zip(_BUFFERS, (
            _edge_entries(self._edges, self._kept), nodes, of(_VALUES * self._count),
            of(_VALUES * self._count, np.int32), of(4 * self._row_slots * self._count),
            of(self._count, np.uint32), of(_VECTORS * self._count), of(_SCALARS + self._groups)))}

    def _node_entries(self, velocities: np.ndarray) -> np.ndarray:
        nodes = np.zeros((2, len(velocities), 4), dtype=np.float32)
        nodes[0, :, :3], nodes[0, :, 3] = self._positions, self._inverse_mass
        nodes[1, :, :3] = velocities + self._step * self._acceleration
        return nodes

    def _compile(self, scene: Scene) -> None:
        defines = paper_solver_defines(self._count, scene.node_count, self._row_slots)
        self._programs = {
            name: Program(ShaderSource(f'paper/solver/{name}.comp', defines))
            for name in (
                'constraint', 'spmm', 'spmv', 'dot', 'scalars', 'update', 'direction')}
        softness = 1.0 / (full_pull(scene, scene['constraint.strain']) * self._step**2)
        for name, uniform, value in (
                ('constraint', 'substep', self._step), ('spmm', 'softness', softness)):
            self._programs[name].use()
            self._programs[name].set_float(uniform, value)
        self._programs['scalars'].use()
        self._programs['scalars'].set_int('group_count', self._groups)

    def _run(
            self, name: str, groups: tuple[int, int] | None = None, **uniforms: int) -> None:
        program = self._programs[name]
        program.use()
        for uniform, value in uniforms.items():
            program.set_int(uniform, value)
        program.dispatch(*(groups or (self._groups, 1)))
        shader_writes_visible()

    def _sum(self, first: int, second: int, stage: int) -> None:
        self._run('dot', first_field=first, second_field=second)
        self._run('scalars', (1, 1), stage=stage)

    def _residual(self) -> float:
        squares = np.empty(2, dtype=np.float32)
        self._buffers['SCALARS'].read_into(squares)
        return float(np.sqrt(squares[0] / squares[1]))


def paper_solver_defines(
        constraints: int, nodes: int, row_slots: int = _ROW_SLOTS[False]) -> dict[str, object]:
    """Return what every shader of the paper's solver compiles in."""
    return {
        'CONSTRAINTS': constraints, 'NODES': nodes, 'ROW_SLOTS': row_slots,
        **{f'PAPER_{name}': binding for binding, name in enumerate(_BUFFERS)}}


def _edge_entries(edges: Edges, kept: np.ndarray) -> np.ndarray:
    # Node numbers are exact in float32 up to 2^24, far beyond what this solver can do.
    columns = (edges.first, edges.second, edges.rest_length, np.zeros(len(edges)))
    return np.stack(columns, axis=1)[kept].astype(np.float32)


# The solvers that can be timed side by side, each with its set-up, for one state and step.

Fields = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Step:
    """
    A step to solve.

    :param hard: whether edges are inextensible, instead of springs
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
        """Free the buffers."""


class _SolverStep:
    name: str
    options: dict[str, Any] = {'tolerance': 1e-2, 'max_iterations': 12}

    def __init__(self, context: Context, scene: Scene, state: Fields, step: Step) -> None:
        """Write the state and compile the passes."""
        self.step = step
        layout = choose_layout(scene, context, tuned=False)
        self._state = State(
            layout, state[0], scene.pinned_nodes(), has_low_parts=needs_low_parts(scene))
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
        """Free the buffers."""
        self._solver.delete()
        self._state.delete()


class MultigridStep(_SolverStep):
    """The solver of the modes; it starts from nothing each time, as in a first step."""

    name = 'multigrid'
    options = {'tolerance': 1e-2, 'max_iterations': 100}


class BlockJacobiStep(_SolverStep):
    """The same without coarser levels, which takes hundreds of iterations."""

    name = 'block_jacobi'
    options = {'tolerance': 1e-2, 'max_iterations': 1000}


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
