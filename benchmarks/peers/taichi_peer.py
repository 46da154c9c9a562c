# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloth in Taichi on one CPU thread: each node gathers from its 12 neighbours."""

import numpy as np
from peers.cloth import Cloth
from peers.cloth import LEAST_SQUARE
import taichi as ti

ti.init(arch=ti.cpu, cpu_max_num_threads=1, fast_math=True, log_level=ti.ERROR)

# Down and right, in the order of Cloth.springs.
_OFFSETS = ((0, 1), (1, 0), (1, 1), (1, -1), (0, 2), (2, 0))


@ti.data_oriented
class TaichiCloth:
    """Fields of vectors, one pair for even steps and one for odd ones."""

    def __init__(self, cloth: Cloth) -> None:
        """Copy the start and compile."""
        shape = cloth.free.shape
        self._positions = tuple(ti.Vector.field(3, ti.f32, shape) for _ in range(2))
        self._velocities = tuple(ti.Vector.field(3, ti.f32, shape) for _ in range(2))
        self._positions[0].from_numpy(cloth.start.astype(np.float32))
        self._free = ti.field(ti.f32, shape)
        self._free.from_numpy(cloth.free.astype(np.float32))
        # What is no field becomes a constant of the kernel.
        self._law = cloth.law(cloth.dt / cloth.node_mass).tolist()
        self._fall = ti.Vector((cloth.dt * cloth.gravity).tolist())
        self._dt = cloth.dt
        self._steps = 0

    def step(self, count: int) -> None:
        """Make ``count`` steps of dt."""
        for _ in range(count):
            self._step(self._steps % 2)
            self._steps += 1
        ti.sync()

    def positions(self) -> np.ndarray:
        """Return where the nodes are, (rows, cols, 3) [m]."""
        return self._positions[self._steps % 2].to_numpy()

    @ti.kernel
    def _step(self, is_odd: ti.template()):
        x, v = ti.static(self._positions[is_odd], self._velocities[is_odd])
        x_out, v_out = ti.static(self._positions[1 - is_odd], self._velocities[1 - is_odd])
        for node in ti.grouped(x):
            change = self._fall
            for kind in ti.static(range(6)):
                for way in ti.static((1, -1)):
                    other = node + way * ti.Vector(_OFFSETS[kind])
                    if 0 <= other[0] < x.shape[0] and 0 <= other[1] < x.shape[1]:
                        change += self._pull(x, v, node, other, kind)
            velocity = v[node] + self._free[node] * change
            v_out[node] = velocity
            x_out[node] = x[node] + self._dt * velocity

    @ti.func
    def _pull(self, x: ti.template(), v: ti.template(), node, other, kind: ti.template()):
        k, kl, kd = ti.static(*self._law)
        d = x[other] - x[node]
        inverse = ti.rsqrt(ti.max(d.dot(d), LEAST_SQUARE))
        rate = d.dot(v[other] - v[node]) * inverse
        return (k[kind] - (kl[kind] - kd[kind] * rate) * inverse) * d
