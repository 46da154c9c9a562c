# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloth in C on one core, vectorised by the compiler: mass_spring.c, loaded with ctypes."""

import ctypes
from functools import cache
import os
from pathlib import Path
import shutil
import subprocess
from tempfile import TemporaryDirectory

import numpy as np
from peers.cloth import Cloth
from peers.cloth import KINDS
from peers.cloth import PeerMissingError

_SOURCE = Path(__file__).with_name('mass_spring.c')
FLAGS = ('-O3', '-march=native', '-ffast-math', '-fPIC')
# As mass_spring.c has them.
_BORDER = 16
_BUFFERS = 11
# Rows whose length is a multiple of this lie in the same sets of the first-level cache [floats].
_CACHE_WAY = 1024
_LINE = 16

_Kinds = ctypes.c_float * KINDS
_Planes = ctypes.c_void_p * 6


class _CCloth(ctypes.Structure):
    _fields_ = [
        ('rows', ctypes.c_int), ('cols', ctypes.c_int), ('pitch', ctypes.c_int),
        ('dt', ctypes.c_float), ('fall', ctypes.c_float * 3), ('k', _Kinds), ('kl', _Kinds),
        ('kd', _Kinds), ('free', ctypes.c_void_p), ('node', ctypes.c_void_p)]


def compiler() -> str:
    """
    Return the path of the C compiler: $CC, or cc.

    :raises PeerMissingError: when there is none
    """
    found = shutil.which(os.environ.get('CC', 'cc'))
    if found is None:
        raise PeerMissingError('there is no C compiler: install gcc, or set CC')
    return found


@cache
def _library() -> ctypes.CDLL:
    with TemporaryDirectory() as folder:
        objects, library = Path(folder, 'peer.o'), Path(folder, 'peer.so')
        subprocess.run([compiler(), *FLAGS, '-c', _SOURCE, '-o', objects], check=True)
        # Linked with -ffast-math, it would have all code of this process flush denormals to zero.
        subprocess.run([compiler(), '-shared', objects, '-o', library, '-lm'], check=True)
        return ctypes.CDLL(str(library))


class _SimdCloth:
    """Planes with a border of zeros, (rows + 4, pitch) float32 each."""

    def __init__(self, cloth: Cloth) -> None:
        """Copy the start and compile."""
        self._library = _library()
        rows, cols = cloth.free.shape
        self._inside = np.s_[2:2 + rows, _BORDER:_BORDER + cols]
        pitch = -(-(cols + 2 * _BORDER) // _LINE) * _LINE
        pitch += _LINE * (pitch % _CACHE_WAY == 0)
        self._shape = (rows + 4, pitch)
        self._planes = [self._bordered(plane) for plane in np.moveaxis(cloth.start, -1, 0)]
        self._planes += [self._bordered(0.0) for _ in range(3)]
        self._masks = self._bordered(cloth.free), self._bordered(1.0)
        self._cloth = _CCloth(
            rows, cols, pitch, cloth.dt, tuple(cloth.dt * cloth.gravity),
            *(tuple(map(float, part)) for part in cloth.law(cloth.dt / cloth.node_mass)),
            *(mask.ctypes.data for mask in self._masks))

    def positions(self) -> np.ndarray:
        """Return where the nodes are, (rows, cols, 3) [m]."""
        return np.stack([plane[self._inside] for plane in self._planes[:3]], axis=-1)

    def _bordered(self, values: np.ndarray | float) -> np.ndarray:
        plane = np.zeros(self._shape, np.float32)
        plane[self._inside] = values
        return plane


class OnceCloth(_SimdCloth):
    """Each spring evaluated once, the state updated in place."""

    def __init__(self, cloth: Cloth) -> None:
        """Copy the start and compile."""
        super().__init__(cloth)
        self._buffers = np.zeros((3 * _BUFFERS, self._shape[1]), np.float32)
        self._pointers = _pointers(self._planes)

    def step(self, count: int) -> None:
        """Make ``count`` steps of dt."""
        self._library.step_once(
            ctypes.byref(self._cloth), self._pointers,
            ctypes.c_void_p(self._buffers.ctypes.data), count)


class GatherCloth(_SimdCloth):
    """Each node gathers from its 12 neighbours, as a thread of a GPU does."""

    def __init__(self, cloth: Cloth) -> None:
        """Copy the start and compile."""
        super().__init__(cloth)
        self._others = [plane.copy() for plane in self._planes]

    def step(self, count: int) -> None:
        """Make ``count`` steps of dt."""
        self._library.step_gather(
            ctypes.byref(self._cloth), _pointers(self._planes), _pointers(self._others), count)
        if count % 2:
            self._planes, self._others = self._others, self._planes


def _pointers(planes: list[np.ndarray]) -> ctypes.Array[ctypes.c_void_p]:
    return _Planes(*(plane.ctypes.data for plane in planes))
