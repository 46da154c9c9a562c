# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the solver keeps on the device, for the lattices of all its levels."""

import math
from typing import NamedTuple

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import most_bytes
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.gl.quick_calls import Call
from cloth_sim_ros.gl.quick_calls import make
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import HALO
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.solver.solver_fields import BEND_SYSTEM
from cloth_sim_ros.sim.solver.solver_fields import BENDING_DAMPING_SYSTEM
from cloth_sim_ros.sim.solver.solver_fields import CLOTH_SYSTEM
from cloth_sim_ros.sim.solver.solver_fields import CLOTH_VECTORS
from cloth_sim_ros.sim.solver.solver_fields import COARSE_SYSTEM
from cloth_sim_ros.sim.solver.solver_fields import CONTACT_SYSTEM
from cloth_sim_ros.sim.solver.solver_fields import CONTACT_VECTORS
from cloth_sim_ros.sim.solver.solver_fields import count
from cloth_sim_ros.sim.solver.solver_fields import numbers
from cloth_sim_ros.sim.solver.solver_fields import SURFACE_SYSTEM
from cloth_sim_ros.sim.solver.solver_fields import SURFACE_VECTORS
from cloth_sim_ros.sim.solver.solver_fields import VECTORS
import numpy as np

# Max. nodes a side of the coarsest level [1]: 64 nodes fit one workgroup, which solves them.
COARSEST_SIDE = 8
# Max. nodes of the levels that one workgroup goes through [1]: with 16 bytes for each and 1,600
# for the coarsest, they fit into the 32 KiB of shared memory that GL 4.3 grants.
MOST_TOGETHER = 1900
# Max. levels [1]: enough for any cloth that buffers can hold, each has half the side of the one
# before.
MOST_LEVELS = 16
# Nodes along each side of an invocation, an even number, and invocations of a workgroup.
# Software runs whole workgroups even where a level ends, so small ones leave less idle.
_ON_SOFTWARE = (4, (8, 2))
# What a tile has to hold for damped bending, or for rigidity beside bend edges: with 4 x 4 nodes
# a program of it takes llvmpipe minutes to compile.
_ON_SOFTWARE_WITH_MUCH = (2, (8, 2))
_ON_GPU = (2, (8, 8))
# Size of an entry, a vec4 [bytes].
_ENTRY_BYTES = 16


class Levels:
    """
    The cloth and, if asked for, ever coarser levels.

    :param state: how the state is stored, by which blocks are chosen
    :param coarsen: False keeps to the cloth alone
    :param has_bend: whether there are bend edges in the system
    :param has_rigidity: whether there is rigidity in it
    :param has_bending_damping: whether there is damped bending in it
    :param has_contact: whether nodes can touch something
    :param has_surface: whether edges and faces can
    """

    def __init__(
            self, state: Layout, *, coarsen: bool, has_bend: bool,
            has_rigidity: bool = False, has_bending_damping: bool = False,
            has_contact: bool = False, has_surface: bool = False) -> None:
        """Lay out all levels."""
        has_much = has_bending_damping or (has_bend and has_rigidity)
        self.layouts = [_layout(state, state.rows, state.cols, has_much)]
        while coarsen and (len(self.layouts) == 1 or self._coarsest_side > COARSEST_SIDE):
            finer = self.layouts[-1]
            self.layouts.append(
                _layout(state, -(-finer.rows // 2), -(-finer.cols // 2), has_much))
        coarse = len(self.layouts) - 1
        cloth_vectors = (
            VECTORS, CLOTH_VECTORS, *[CONTACT_VECTORS] * has_contact,
            *[SURFACE_VECTORS] * has_surface)
        cloth_system = (
            CLOTH_SYSTEM, *[BEND_SYSTEM] * has_bend,
            *[BENDING_DAMPING_SYSTEM] * has_bending_damping, *[CONTACT_SYSTEM] * has_contact,
            *[SURFACE_SYSTEM] * has_surface)
        # A shader can name a field that no scene of this kind has.
        self._fields = {
            **numbers(VECTORS, CLOTH_VECTORS, CONTACT_VECTORS, SURFACE_VECTORS),
            **numbers(COARSE_SYSTEM),
            **numbers(BEND_SYSTEM, BENDING_DAMPING_SYSTEM, CONTACT_SYSTEM, SURFACE_SYSTEM),
            **numbers(*cloth_system)}
        vectors = [count(*cloth_vectors)] + [count(VECTORS)] * coarse
        system = [count(*cloth_system)] + [count(COARSE_SYSTEM)] * coarse
        stored = np.array([layout.stored for layout in self.layouts])
        ends = np.cumsum([stored * vectors, stored * system], axis=1)
        self._begins = (ends - [stored * vectors, stored * system]).T
        self.vector_bytes, self.system_bytes = (int(end) * _ENTRY_BYTES for end in ends[:, -1])

    @property
    def cloth(self) -> Layout:
        """Return the finest level."""
        return self.layouts[0]

    @property
    def sum_count(self) -> int:
        """Return how many sums passes over the cloth leave."""
        cloth = self.cloth
        return math.prod(cloth.groups) * (math.prod(cloth.local) if cloth.texture_loads else 1)

    @property
    def coarsest(self) -> int:
        """Return the number of the last level."""
        return len(self.layouts) - 1

    @property
    def first_together(self) -> int:
        """Return the first coarse level that fits one workgroup with all that are coarser."""
        nodes = np.cumsum([layout.rows * layout.cols for layout in reversed(self.layouts[1:])])
        return len(self.layouts) - int(np.count_nonzero(nodes <= MOST_TOGETHER))

    def defines(self) -> dict[str, object]:
        """Return what levels.glsl compiles in, without the lattice of the cloth."""
        return {'MOST_LEVELS': MOST_LEVELS, **self._fields}

    def set_in(self, program: Program) -> None:
        """Set the uniforms of the lattices of all levels in the program in use."""
        self.cloth.set_in(program)
        program.set_int_vectors('level_shape', np.array([
            (layout.rows, layout.cols, layout.pitch, layout.stored) for layout in self.layouts]))
        program.set_int_vectors('level_begin', self._begins)

    @property
    def _coarsest_side(self) -> int:
        return max(self.layouts[-1].rows, self.layouts[-1].cols)


class _InLine(Layout):
    """Counts blocks row by row, see solver/block_of_invocation.glsl."""

    @property
    def groups(self) -> tuple[int, int]:
        across, down = (-(-nodes // self.block) for nodes in (self.cols, self.rows))
        return -(-across * down // math.prod(self.local)), 1


def _layout(state: Layout, rows: int, cols: int, has_much: bool) -> Layout:
    if state.texture_loads:
        return _InLine(
            rows, cols, 'fused', True, *(_ON_SOFTWARE_WITH_MUCH if has_much else _ON_SOFTWARE))
    return Layout(rows, cols, 'fused', False, *_ON_GPU)


# What the solver keeps on the device.

_VECTOR = numbers(VECTORS, CLOTH_VECTORS, CONTACT_VECTORS, SURFACE_VECTORS)
RESIDUAL, PRODUCT, PRECONDITIONED = (
    _VECTOR[name] for name in ('RESIDUAL', 'PRODUCT', 'PRECONDITIONED'))
SOLUTION, CHANGE, START, LEFT = (
    _VECTOR[name] for name in ('SOLUTION', 'CHANGE', 'START', 'LEFT'))
SURFACE_VALUE = _VECTOR['SURFACE_VALUE']
_SYSTEM = numbers(CLOTH_SYSTEM, BEND_SYSTEM)
TENSION, BEND_TENSION = _SYSTEM['TENSION'], _SYSTEM['BEND_TENSION']


class Scalars(NamedTuple):
    """What solver/scalars.glsl lists."""

    step_length: float
    keep: float
    measure: float
    measure_start: float
    measure_after: float
    iterations: float
    is_going: float
    finished_groups: float
    is_off: float
    scale: float


_SCALARS = len(Scalars._fields)
_ITERATIONS_AT = Scalars._fields.index('iterations') * np.dtype(np.float32).itemsize


class _Large(NamedTuple):
    vectors: Buffer
    system: Buffer
    sums: Buffer


class SolverBuffers:
    """
    Vectors and system of all levels, partial sums, scalars and workgroup counts.

    What grows with the cloth is allocated when it is first bound, as zero; ghosts stay so. A cloth
    in mode adaptive that never comes to its limit does without.
    """

    def __init__(self, levels: Levels, dispatch_count: int) -> None:
        """
        Allocate what is small.

        :raises DeviceError: when the device has no buffers as large as will be needed
        """
        refuse_too_large(levels, most_bytes())
        self._cloth = levels.cloth
        self.sum_count = levels.sum_count
        # One more for what edges and faces in contact add.
        self._sizes = (
            levels.vector_bytes, levels.system_bytes, (self.sum_count + 1) * _ENTRY_BYTES)
        self._large: _Large | None = None
        self._bind_calls: list[Call] | None = None
        self._scalars = Buffer(np.zeros(_SCALARS, dtype=np.float32), is_polled=True)
        self._dispatches = Buffer(np.zeros((dispatch_count, 3), dtype=np.uint32))
        # How many iterations were made, and whether the device wants another one.
        self._progress = np.zeros(2, dtype=np.float32)

    def bind(self) -> None:
        """Let the passes of the solver reach everything."""
        if self._bind_calls is None:
            self._bind_calls = self._calls_of_bind(self._allocated())
        make(self._bind_calls)

    def clear(self) -> None:
        """Set all to zero, as at the start: a NaN would stay where it is multiplied."""
        self._release()
        for buffer in (self._scalars, self._dispatches):
            buffer.clear()

    def clear_scalars(self, *, keep_scale: bool) -> None:
        """Forget the last solve, but for its scale if that is to be kept."""
        self._scalars.write(np.zeros(_SCALARS - int(keep_scale), dtype=np.float32))

    def scalars(self) -> Scalars:
        """Return how the last solve went."""
        values = np.empty(_SCALARS, dtype=np.float32)
        self._scalars.read_into(values)
        return Scalars(*values.tolist())

    def sums(self, *, with_surface: bool = False) -> tuple[float, float, float]:
        """
        Return what a pass has stored by partial_sums.glsl, added up.

        :param with_surface: add what surface_product.comp has stored
        """
        values = np.empty((self.sum_count + int(with_surface), 4), dtype=np.float32)
        self._allocated().sums.read_into(values)
        first, second, third, _ = values.sum(axis=0, dtype=np.float64)
        return float(first), float(second), float(third)

    def is_off(self) -> bool:
        """Return whether lengths are off by more than rounding, before a further solve."""
        return self.scalars().is_off != 0.0

    def progress(self) -> tuple[int, bool]:
        """Return how many iterations were made, and whether the device wants another one."""
        self._scalars.read_into(self._progress, _ITERATIONS_AT)
        iterations, is_going = self._progress.tolist()
        return int(iterations), is_going > 0.0

    def copy(self, field: int, into: int) -> None:
        """Copy a vector of the cloth into another one."""
        size = self._cloth.stored * _ENTRY_BYTES
        self._allocated().vectors.copy(field * size, into * size, size)

    def read(self, field: int) -> np.ndarray:
        """Return a vector of the cloth, (rows, cols, 3)."""
        values = np.empty((self._cloth.stored, 4), dtype=np.float32)
        self._allocated().vectors.read_into(values, field * values.nbytes)
        lattice = values.reshape(-1, self._cloth.pitch, 4)
        return lattice[HALO:HALO + self._cloth.rows, HALO:HALO + self._cloth.cols, :3]

    def write(self, field: int, values: np.ndarray) -> None:
        """Replace a vector of the cloth by (rows, cols, 3) ``values``."""
        padded = np.pad(np.asarray(values, dtype=np.float32), ((0, 0), (0, 0), (0, 1)))
        stored = self._cloth.store(padded)
        self._allocated().vectors.write(stored, field * stored.nbytes)

    def read_system(self, field: int) -> np.ndarray:
        """Return a field of the system of the cloth, (rows, cols, 4)."""
        values = np.empty((self._cloth.stored, 4), dtype=np.float32)
        self._allocated().system.read_into(values, field * values.nbytes)
        return self._cloth.load(values)

    def delete(self) -> None:
        """Release everything."""
        self._release()
        for buffer in (self._scalars, self._dispatches):
            buffer.delete()

    def _allocated(self) -> _Large:
        if self._large is None:
            self._large = _Large(*(Buffer(size) for size in self._sizes))
            for buffer in self._large:
                buffer.clear()
        return self._large

    def _release(self) -> None:
        for buffer in self._large or ():
            buffer.delete()
        self._large = None
        self._bind_calls = None

    def _calls_of_bind(self, large: _Large) -> list[Call]:
        places = (
            (large.vectors, bindings.SOLVER_VECTORS), (large.system, bindings.SOLVER_SYSTEM),
            (large.sums, bindings.SOLVER_SUMS))
        calls = [buffer.storage_call(place) for buffer, place in (
            *places, (self._scalars, bindings.SOLVER_SCALARS),
            (self._dispatches, bindings.SOLVER_DISPATCHES))]
        calls.append(self._dispatches.dispatches_call())
        if self._cloth.texture_loads:
            for buffer, place in places:
                calls += buffer.texture_calls(place)
        return calls


def refuse_too_large(levels: Levels, limit: int) -> None:
    """Raise DeviceError when a buffer of the solver is above ``limit`` bytes."""
    needed = max(levels.vector_bytes, levels.system_bytes)
    if needed > limit:
        cloth = levels.cloth
        side = int((cloth.rows * cloth.cols * limit / needed)**0.5)
        raise DeviceError(
            f'the implicit solver needs a buffer of {needed} bytes for rows {cloth.rows} x cols '
            f'{cloth.cols}, this device allows {limit}: use up to about {side} x {side}, or '
            'mode mass_spring')
