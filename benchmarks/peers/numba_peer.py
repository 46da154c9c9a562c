# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloth in numba: row by row on one thread, each spring evaluated once, updated in place."""

import numba
import numpy as np
from peers.cloth import Cloth
from peers.cloth import LEAST_SQUARE

_LEAST = np.float32(LEAST_SQUARE)
_ONE = np.float32(1.0)
# Down and right, in the order of Cloth.springs.
_OFFSETS = ((0, 1), (1, 0), (1, 1), (1, -1), (0, 2), (2, 0))


@numba.njit(fastmath=True)
def _pull_row(x0, y0, z0, x1, y1, z1, u0, v0, w0, u1, v1, w1, fx, fy, fz, k, kl, kd):
    """Set (fx, fy, fz) to the forces on the first ends of a row of springs."""
    for c in range(len(fx)):
        dx, dy, dz = x1[c] - x0[c], y1[c] - y0[c], z1[c] - z0[c]
        inverse = _ONE / np.sqrt(max(dx * dx + dy * dy + dz * dz, _LEAST))
        rate = inverse * (
            dx * (u1[c] - u0[c]) + dy * (v1[c] - v0[c]) + dz * (w1[c] - w0[c]))
        pull = k - inverse * (kl - kd * rate)
        fx[c] = pull * dx
        fy[c] = pull * dy
        fz[c] = pull * dz


@numba.njit(fastmath=True)
def _add(total, part):
    for c in range(len(part)):
        total[c] += part[c]


@numba.njit(fastmath=True)
def _subtract(total, part):
    for c in range(len(part)):
        total[c] -= part[c]


@numba.njit(fastmath=True)
def _move(position, velocity, force, free, fall, h):
    for c in range(len(free)):
        velocity[c] += free[c] * (fall + force[c])
        position[c] += h * velocity[c]
        force[c] = np.float32(0.0)


@numba.njit(fastmath=True)
def _steps(x, y, z, u, v, w, fx, fy, fz, free, buffer, law, fall, h, count):
    rows, cols = x.shape
    for _ in range(count):
        for r in range(rows):
            for kind in range(6):
                down, right = _OFFSETS[kind]
                if r + down >= rows:
                    continue
                length = cols - abs(right)
                a = max(-right, 0)
                b = a + right
                s = r + down
                gx, gy, gz = buffer[0, :length], buffer[1, :length], buffer[2, :length]
                _pull_row(
                    x[r, a:a + length], y[r, a:a + length], z[r, a:a + length],
                    x[s, b:b + length], y[s, b:b + length], z[s, b:b + length],
                    u[r, a:a + length], v[r, a:a + length], w[r, a:a + length],
                    u[s, b:b + length], v[s, b:b + length], w[s, b:b + length],
                    gx, gy, gz, law[0, kind], law[1, kind], law[2, kind])
                _add(fx[r, a:a + length], gx)
                _add(fy[r, a:a + length], gy)
                _add(fz[r, a:a + length], gz)
                _subtract(fx[s, b:b + length], gx)
                _subtract(fy[s, b:b + length], gy)
                _subtract(fz[s, b:b + length], gz)
            # No spring that is still to come has an end in this row.
            _move(x[r], u[r], fx[r], free[r], fall[0], h)
            _move(y[r], v[r], fy[r], free[r], fall[1], h)
            _move(z[r], w[r], fz[r], free[r], fall[2], h)


class NumbaCloth:
    """Planes of float32, (rows, cols) each."""

    def __init__(self, cloth: Cloth) -> None:
        """Copy the start and compile."""
        planes = np.moveaxis(cloth.start, -1, 0).astype(np.float32)
        self._planes = [plane.copy() for plane in planes]
        self._planes += [np.zeros_like(plane) for plane in (*planes, *planes)]
        self._rest = (
            cloth.free.astype(np.float32), np.zeros((3, cloth.free.shape[1]), np.float32),
            cloth.law(cloth.dt / cloth.node_mass),
            (cloth.dt * cloth.gravity).astype(np.float32), np.float32(cloth.dt))
        self.step(0)

    def step(self, count: int) -> None:
        """Make ``count`` steps of dt."""
        _steps(*self._planes, *self._rest, count)

    def positions(self) -> np.ndarray:
        """Return where the nodes are, (rows, cols, 3) [m]."""
        return np.stack(self._planes[:3], axis=-1)
