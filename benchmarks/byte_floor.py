# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
How near passes come to the time that memory takes for the bytes they have to move.

For example:
  LP_NUM_THREADS=0 python benchmarks/byte_floor.py
"""

from collections.abc import Callable
from collections.abc import Iterator
from collections.abc import Sequence
from dataclasses import dataclass
import statistics
import time

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.device.layout import choose_layout
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.modes.mass_spring import OnePass
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.solver.active_set import RightSide
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import spring_law
from cloth_sim_ros.sim.solver.solver_buffers import CHANGE
from cloth_sim_ros.sim.solver.solver_buffers import Levels
from cloth_sim_ros.sim.solver.solver_buffers import SolverBuffers
from cloth_sim_ros.sim.solver.solver_programs import POINT_LOCAL
from cloth_sim_ros.sim.solver.solver_programs import POINTS
from cloth_sim_ros.sim.solver.solver_programs import SolverPass
from cloth_sim_ros.sim.solver.solver_programs import SolverPrograms
from cloth_sim_ros.sim.solver.start import Start
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.study.solver_speed import unit_scene
from cloth_sim_ros.study.speed import bench_scene
import numpy as np

_ENTRY_BYTES = 16
_STEP = 0.01
_TURN_SECONDS = 0.03
_PAGE_FLOATS = 1024


@dataclass(frozen=True)
class Traffic:
    """
    Fields of 16 bytes a node that a pass has to load, and to store, once each.

    Vectors of the solver are named by their first word in shaders/include/solver/levels.glsl, its
    system as well.

    :param coarse: fields that it stores for each node of the next level, of which there are a
        quarter as many
    :param sums: entries that it loads or stores for each block of nodes
    """

    loads: frozenset[str] = frozenset()
    stores: frozenset[str] = frozenset()
    coarse: frozenset[str] = frozenset()
    sums: int = 0

    def moved_bytes(self, nodes: int, coarse_nodes: int, blocks: int) -> int:
        """Return the least that it moves on a cloth of ``nodes`` in ``blocks``."""
        of_each = len(self.loads) + len(self.stores)
        return _ENTRY_BYTES * (
            of_each * nodes + len(self.coarse) * coarse_nodes + self.sums * blocks)


_STATE = frozenset({'position', 'velocity'})
_EDGES = frozenset({'NODE', 'ALONG', 'ACROSS', 'BEND_WEIGHT'})
_INVERSE = frozenset({'INVERSE', 'INVERSE + 1'})

# With the springs of all families, without contact and without bending by curvature.
TRAFFIC = {
    'substep of mass_spring': Traffic(_STATE, _STATE),
    'right side': Traffic(
        _STATE | {'CHANGE', 'TENSION', 'BEND_TENSION'},
        _EDGES | {'RESIDUAL', 'BEGUN', 'BEND_TENSION'}),
    'assembly': Traffic(_EDGES, _INVERSE),
    'coarsening': Traffic(_EDGES, coarse=frozenset(f'coarse {field}' for field in range(2, 10))),
    'product': Traffic(
        _EDGES | {'PRECONDITIONED', 'RESIDUAL', 'SOLUTION'}, frozenset({'PRODUCT'}), sums=1),
    'smoothing': Traffic(
        _EDGES | _INVERSE | {'PRODUCT', 'RESIDUAL'}, frozenset({'PRECONDITIONED'})),
    'reduction': Traffic(sums=1),
    'update': Traffic(
        _INVERSE | {'PRECONDITIONED', 'PRODUCT', 'SOLUTION', 'RESIDUAL', 'DIRECTION', 'IMAGE'},
        frozenset({'DIRECTION', 'IMAGE', 'SOLUTION', 'RESIDUAL', 'PRODUCT'})),
}
# Fields of the solver; the smoothed residual shares that of the product (levels.glsl).
VECTOR_FIELDS = (
    'RESIDUAL', 'PRODUCT', 'PRECONDITIONED', 'DIRECTION', 'IMAGE', 'SOLUTION', 'CHANGE', 'START')
SYSTEM_FIELDS = (
    'INVERSE', 'INVERSE + 1', 'NODE', 'ALONG', 'ACROSS', 'TENSION', 'BEGUN', 'BEND_WEIGHT',
    'BEND_TENSION')


class SolverPasses:
    """
    The passes of one solve, on buffers of their own, in their order; values cost no time.

    :param law: of the edges; that of the scene's springs when None
    """

    def __init__(self, size: int, context: Context, law: EdgeLaw | None = None) -> None:
        """Compile the passes, and run each twice, so that all fields have values."""
        scene = unit_scene(size)
        layout = choose_layout(scene, context, tuned=False)
        self.state = State(layout, scene.start_positions(), scene.pinned_nodes())
        random = np.random.default_rng(1)
        self.state.write(
            scene.start_positions() + random.uniform(-0.1, 0.1, (size, size, 3)) / size,
            random.uniform(-1.0, 1.0, (size, size, 3)))
        self.levels = Levels(layout, coarsen=True, has_bend=True)
        self.buffers = SolverBuffers(self.levels, 1)
        programs = SolverPrograms(
            layout, self.levels, FAMILIES, is_multigrid=True, has_rigidity=False,
            has_bending_damping=False)
        self._programs = programs
        self._law = law or spring_law(scene, _STEP)
        self._forcing = Forcing(scene['gravity'])
        self._right_side = RightSide(scene, layout, programs, self.levels, foresees_turn=False)
        cloth, coarse = self.levels.layouts[:2]
        points = (-(-cloth.stored // (POINTS * POINT_LOCAL)), 1)
        self.passes: dict[str, Callable[[], None]] = {
            'right side': self._make_right_side,
            'assembly': SolverPass(programs.make('assemble.comp'), cloth.node_groups).run,
            'coarsening': SolverPass(
                programs.make('coarsen_cloth.comp'), coarse.node_groups, level=1).run,
            'smoothing': SolverPass(
                programs.make('cloth_smooth.comp'), cloth.groups, goes_up=False,
                finds_defect=False).run,
            'product': SolverPass(programs.make('product.comp'), cloth.groups).run,
            'reduction': self._reduction(programs),
            'update': SolverPass(programs.make('update.comp'), points).run}
        programs.set_law(self._law)
        self.bind()
        for _ in range(2):
            for run in self.passes.values():
                run()

    def bind(self) -> None:
        """Let the passes reach the buffers."""
        self.buffers.bind()
        self.state.bind_in()

    def delete(self) -> None:
        """Free all resources."""
        self._programs.delete()
        self._right_side.delete()
        self.buffers.delete()
        self.state.delete()

    def _make_right_side(self) -> None:
        self._right_side.run(
            self._law, self._forcing, _STEP, Start(CHANGE, 1.0), is_further=False)

    def _reduction(self, programs: SolverPrograms) -> Callable[[], None]:
        reduce = programs.make('reduce.comp', MOST_GROUPS_COUNTS=1)
        reduce.set_int('sum_count', self.buffers.sum_count)
        return SolverPass(reduce, (1, 1)).run


@dataclass(frozen=True)
class FloorRatio:
    """
    A pass beside a copy that moves as many bytes.

    :param least_bytes: that the pass moves
    :param pass_time: wall time, median over the rounds [s]
    :param copy_time: of the copy, which loads one half and stores the other [s]
    :param ratio: of both, median over the rounds
    :param ratios: of each round
    """

    name: str
    size: int
    least_bytes: int
    pass_time: float
    copy_time: float
    ratio: float
    ratios: tuple[float, ...]


def _mass_spring(size: int, context: Context) -> Iterator[tuple[str, int, Callable[[], None]]]:
    scene = bench_scene(size, {})
    layout = choose_layout(scene, context, tuned=False)
    state = State(layout, scene.start_positions(), scene.pinned_nodes())
    step = OnePass(scene, layout)
    forcing = Forcing(scene['gravity'])
    name = 'substep of mass_spring'
    yield name, TRAFFIC[name].moved_bytes(size * size, 0, 0), lambda: step.substep(
        state, forcing, scene['dt'])
    step.delete()
    state.delete()


def _solver(size: int, context: Context) -> Iterator[tuple[str, int, Callable[[], None]]]:
    passes = SolverPasses(size, context)
    coarse = passes.levels.layouts[1]
    passes.bind()
    for name, run in passes.passes.items():
        yield name, TRAFFIC[name].moved_bytes(
            size * size, coarse.rows * coarse.cols, passes.buffers.sum_count), run
    passes.delete()


def floor_ratios(
        sizes: Sequence[int], solver_sizes: Sequence[int], rounds: int,
        turn_seconds: float = _TURN_SECONDS) -> Iterator[FloorRatio]:
    """
    Yield the ratio of each pass for each size; in a round, pass and copy take turns.

    :param turn_seconds: wall time that a turn aims at [s]
    """
    context = Context(single_thread=True)
    for passes_of, its_sizes in ((_mass_spring, sizes), (_solver, solver_sizes)):
        for size in its_sizes:
            for name, least_bytes, run in passes_of(size, context):
                yield _measured(context, name, size, least_bytes, run, rounds, turn_seconds)
    context.close()


def _measured(
        context: Context, name: str, size: int, least_bytes: int, run: Callable[[], None],
        rounds: int, turn_seconds: float) -> FloorRatio:
    source, target = _copied(least_bytes // 8)

    def copy() -> None:
        np.copyto(target, source)

    counts = [
        max(1, round(turn_seconds / min(_mean_time(each, 2, context) for _ in range(3))))
        for each in (run, copy)]
    times = [
        [_mean_time(each, count, context) for each, count in zip((run, copy), counts)]
        for _ in range(rounds)]
    ratios = tuple(of_pass / of_copy for of_pass, of_copy in times)
    pass_time, copy_time = (statistics.median(column) for column in zip(*times))
    return FloorRatio(
        name, size, least_bytes, pass_time, copy_time, statistics.median(ratios), ratios)


def _copied(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return two arrays of ``count`` floats, half a page apart beside whole pages."""
    # Loads wait for stores whose addresses end in the same 12 bits: a tenth of the speed.
    apart = -(-count // _PAGE_FLOATS) * _PAGE_FLOATS + _PAGE_FLOATS // 2
    memory = np.ones(apart + count, dtype=np.float32)
    return memory[:count], memory[apart:]


def _mean_time(run: Callable[[], None], count: int, context: Context) -> float:
    context.finish()
    begin = time.perf_counter()
    for _ in range(count):
        run()
    context.finish()
    return (time.perf_counter() - begin) / count


def main() -> None:
    """Print the table of docs/notes/performance.md."""
    print('| pass | nodes | bytes a node | copy [GB/s] | copy [us] | pass [us] | pass / copy |')
    print('|---|---|---|---|---|---|---|')
    for each in floor_ratios((64, 256, 1024), (64, 128, 256), 9):
        print(
            f'| {each.name} | {each.size} x {each.size} | {each.least_bytes / each.size**2:.0f} '
            f'| {each.least_bytes / each.copy_time / 1e9:.1f} | {1e6 * each.copy_time:.3g} '
            f'| {1e6 * each.pass_time:.4g} '
            f'| {each.ratio:.2g} ({min(each.ratios):.2g}-{max(each.ratios):.2g}) |', flush=True)


if __name__ == '__main__':
    main()
