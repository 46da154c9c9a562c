# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloth in NVIDIA Warp on the CPU: one thread a node, which gathers from 12 neighbours."""

import numpy as np
from peers.cloth import Cloth
from peers.cloth import LEAST_SQUARE
import warp as wp

wp.init()
# fast_math is for CUDA alone. Clang's -ffast-math and -O3 made no difference here.
wp.set_module_options({'enable_backward': False})

_Kinds = wp.types.vector(length=6, dtype=float)
_LEAST = wp.constant(LEAST_SQUARE)


@wp.func
def _pull(
        x: wp.array2d(dtype=wp.vec3), v: wp.array2d(dtype=wp.vec3), i: int, j: int, down: int,
        right: int, k: float, kl: float, kd: float):
    a, b = i + down, j + right
    if a < 0 or a >= x.shape[0] or b < 0 or b >= x.shape[1]:
        return wp.vec3()
    d = x[a, b] - x[i, j]
    inverse = 1.0 / wp.sqrt(wp.max(wp.dot(d, d), _LEAST))
    rate = wp.dot(v[a, b] - v[i, j], d) * inverse
    return (k - (kl - kd * rate) * inverse) * d


@wp.func
def _both(
        x: wp.array2d(dtype=wp.vec3), v: wp.array2d(dtype=wp.vec3), i: int, j: int, down: int,
        right: int, k: float, kl: float, kd: float):
    return (_pull(x, v, i, j, down, right, k, kl, kd)
            + _pull(x, v, i, j, -down, -right, k, kl, kd))


@wp.kernel
def _step(
        x: wp.array2d(dtype=wp.vec3), v: wp.array2d(dtype=wp.vec3),
        free: wp.array2d(dtype=float), k: _Kinds, kl: _Kinds, kd: _Kinds, fall: wp.vec3,
        h: float, x_out: wp.array2d(dtype=wp.vec3), v_out: wp.array2d(dtype=wp.vec3)):
    i, j = wp.tid()
    change = (
        fall + _both(x, v, i, j, 0, 1, k[0], kl[0], kd[0])
        + _both(x, v, i, j, 1, 0, k[1], kl[1], kd[1])
        + _both(x, v, i, j, 1, 1, k[2], kl[2], kd[2])
        + _both(x, v, i, j, 1, -1, k[3], kl[3], kd[3])
        + _both(x, v, i, j, 0, 2, k[4], kl[4], kd[4])
        + _both(x, v, i, j, 2, 0, k[5], kl[5], kd[5]))
    velocity = v[i, j] + free[i, j] * change
    v_out[i, j] = velocity
    x_out[i, j] = x[i, j] + h * velocity


class WarpCloth:
    """Arrays of vec3, a pair for the state before a step and one for that after it."""

    def __init__(self, cloth: Cloth) -> None:
        """Copy the start and compile."""
        start = cloth.start.astype(np.float32)
        given = {'dtype': wp.vec3, 'device': 'cpu'}
        self._states = [
            (wp.array(start, **given), wp.zeros(start.shape[:2], **given)) for _ in range(2)]
        law = [_Kinds(*map(float, part)) for part in cloth.law(cloth.dt / cloth.node_mass)]
        rest = [
            wp.array(cloth.free.astype(np.float32), dtype=float, device='cpu'), *law,
            wp.vec3(*map(float, cloth.dt * cloth.gravity)), cloth.dt]
        # Recorded launches: packing the arguments each time costs more than a small cloth.
        self._launches = [
            wp.launch(_step, dim=start.shape[:2], inputs=[*before, *rest], outputs=[*after],
                      device='cpu', record_cmd=True)
            for before, after in (self._states, reversed(self._states))]
        self._steps = 0

    def step(self, count: int) -> None:
        """Make ``count`` steps of dt."""
        for _ in range(count):
            self._launches[self._steps % 2].launch()
            self._steps += 1
        wp.synchronize_device('cpu')

    def positions(self) -> np.ndarray:
        """Return where the nodes are, (rows, cols, 3) [m]."""
        return self._states[self._steps % 2][0].numpy().copy()
