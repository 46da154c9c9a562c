# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the solver keeps on the device."""

import math

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import most_bytes
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.sim import bindings
from cloth_sim_ros.sim.layout import HALO
from cloth_sim_ros.sim.solver.levels import Levels
import numpy as np

TENSION, BEND_TENSION = 5, 8
RESIDUAL, PRODUCT, PRECONDITIONED, DIRECTION, IMAGE, SOLUTION, CHANGE, START = range(8)
_SCALARS = 7
_ENTRY_BYTES = 16


class SolverBuffers:
    """Vectors and system of all levels, partial sums, scalars and workgroup counts."""

    def __init__(self, levels: Levels, dispatch_count: int) -> None:
        """
        Allocate everything; ghosts are zero and stay so.

        :raises DeviceError: when the device has no buffers that large
        """
        refuse_too_large(levels, most_bytes())
        self._cloth = levels.cloth
        self.sum_count = math.prod(self._cloth.groups)
        if self._cloth.texture_loads:
            self.sum_count *= math.prod(self._cloth.local)
        self._vectors = _zeros(levels.vector_bytes)
        self._system = _zeros(levels.system_bytes)
        self._sums = _zeros(self.sum_count * _ENTRY_BYTES)
        self._scalars = Buffer(np.zeros(_SCALARS, dtype=np.float32))
        self._dispatches = Buffer(np.zeros((dispatch_count, 3), dtype=np.uint32))
        # Workgroups of the first dispatch, along x.
        self._going = np.zeros(1, dtype=np.uint32)

    def bind(self) -> None:
        """Let the passes of the solver reach everything."""
        self._vectors.bind_storage(bindings.SOLVER_VECTORS)
        self._system.bind_storage(bindings.SOLVER_SYSTEM)
        self._sums.bind_storage(bindings.SOLVER_SUMS)
        self._scalars.bind_storage(bindings.SOLVER_SCALARS)
        self._dispatches.bind_storage(bindings.SOLVER_DISPATCHES)
        self._dispatches.bind_dispatches()
        if self._cloth.texture_loads:
            self._vectors.bind_texture(bindings.SOLVER_VECTORS)
            self._system.bind_texture(bindings.SOLVER_SYSTEM)
            self._sums.bind_texture(bindings.SOLVER_SUMS)

    def clear(self) -> None:
        """Make all zero, as at the start: what is no number would stay where it is multiplied."""
        for buffer in (self._vectors, self._system, self._sums, self._scalars, self._dispatches):
            buffer.write(np.zeros(buffer.bytes // 4, dtype=np.uint32))

    def clear_scalars(self, *, keep_scale: bool) -> None:
        """Forget the last solve, but for its scale if that is to be kept."""
        self._scalars.write(np.zeros(_SCALARS - int(keep_scale), dtype=np.float32))

    def scalars(self) -> np.ndarray:
        """Return what solver/scalars.glsl lists."""
        values = np.empty(_SCALARS, dtype=np.float32)
        self._scalars.read_into(values)
        return values

    def sums(self) -> tuple[float, float, float]:
        """Return what a pass has stored by partial_sums.glsl, added up."""
        values = np.empty((self.sum_count, 4), dtype=np.float32)
        self._sums.read_into(values)
        first, second, third, _ = values.sum(axis=0, dtype=np.float64)
        return float(first), float(second), float(third)

    def scale(self) -> float:
        """Return the square of the change of velocity that the last solve was judged beside."""
        return float(self.scalars()[6])

    def is_going(self) -> bool:
        """Return whether the device wants another iteration."""
        self._dispatches.read_into(self._going)
        return bool(self._going[0])

    def iterations(self) -> int:
        """Return how many iterations the last solve has made."""
        return int(self.scalars()[5])

    def read(self, field: int) -> np.ndarray:
        """Return a vector of the cloth, (rows, cols, 3)."""
        values = np.empty((self._cloth.stored, 4), dtype=np.float32)
        self._vectors.read_into(values, field * values.nbytes)
        lattice = values.reshape(-1, self._cloth.pitch, 4)
        return lattice[HALO:HALO + self._cloth.rows, HALO:HALO + self._cloth.cols, :3]

    def write(self, field: int, values: np.ndarray) -> None:
        """Replace a vector of the cloth by (rows, cols, 3) ``values``."""
        padded = np.pad(np.asarray(values, dtype=np.float32), ((0, 0), (0, 0), (0, 1)))
        stored = self._cloth.store(padded)
        self._vectors.write(stored, field * stored.nbytes)

    def read_system(self, field: int) -> np.ndarray:
        """Return a field of the system of the cloth, (rows, cols, 4)."""
        values = np.empty((self._cloth.stored, 4), dtype=np.float32)
        self._system.read_into(values, field * values.nbytes)
        return self._cloth.load(values)

    def delete(self) -> None:
        """Give everything back."""
        for buffer in (
                self._vectors, self._system, self._sums, self._scalars, self._dispatches):
            buffer.delete()


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


def _zeros(size: int) -> Buffer:
    return Buffer(np.zeros(size // 4, dtype=np.float32))
