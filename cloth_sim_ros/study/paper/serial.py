# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The serial program of the paper in plain C, compiled when it is first used."""

import ctypes
from functools import cache
import os
from pathlib import Path
import shutil
import subprocess
from tempfile import TemporaryDirectory
from typing import Protocol

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.paper.serial_model import NumpyCloth
from cloth_sim_ros.study.paper.serial_model import SerialModel
import numpy as np

_SOURCE = Path(__file__).with_name('serial_cloth.c')
_COMPILERS = ('cc', 'gcc', 'clang')
# Default flags of a C program: instructions of the base architecture only, no fast math.
_FLAGS = ('-O2', '-shared', '-fPIC')
_COMPILE_SECONDS = 60.0


class SerialCloth(Protocol):
    """What both serial programs offer."""

    name: str
    iterations: int
    positions: np.ndarray
    velocities: np.ndarray

    @property
    def held(self) -> int:
        """Return how many edges were constraints in the last step."""

    def set_state(self, positions: np.ndarray, velocities: np.ndarray) -> None:
        """Replace positions [m] and velocities [m/s], (rows, cols, 3)."""

    def step(self) -> None:
        """Make one step of h."""

    def finish(self) -> None:
        """Return when all steps are done."""

    def close(self) -> None:
        """Free all resources."""


def serial_cloth(
        model: SerialModel, positions: np.ndarray, velocities: np.ndarray) -> SerialCloth:
    """
    Return the serial program in C, or in NumPy where no C compiler works.

    :param positions: (rows, cols, 3) [m]
    :param velocities: (rows, cols, 3) [m/s]
    :raises ClothSimError: when a matrix is to be formed pair by pair, and there is no compiler
    """
    if compiled_library() is not None:
        return CompiledCloth(model, positions, velocities)
    if model.forms_matrix:
        raise ClothSimError(
            'the matrix of constraints is formed pair by pair in C alone, and no C compiler '
            'works: install gcc, or set CC to one')
    return NumpyCloth(model, positions, velocities)


class CompiledCloth:
    """
    The serial program in C.

    :param model: what is stepped
    :param positions: (rows, cols, 3) [m]
    :param velocities: (rows, cols, 3) [m/s]
    """

    name = f'C ({" ".join(_FLAGS[:1])}), float32'

    def __init__(
            self, model: SerialModel, positions: np.ndarray, velocities: np.ndarray) -> None:
        """Copy model and state into arrays of float32."""
        library = compiled_library()
        assert library is not None  # serial_cloth has asked
        self._library = library
        edges = model.edges
        self._arrays = {
            'first': edges.first.astype(np.int32), 'second': edges.second.astype(np.int32),
            'rest': _floats(edges.rest_length), 'stiffness': _floats(edges.stiffness),
            'damping': _floats(edges.damping), 'inverse_mass': _floats(model.inverse_masses),
            'force': np.zeros((len(model.inverse_masses), 3), np.float32)}
        if model.limited is not None and model.diagonal is not None:
            self._arrays |= {
                'limited': model.limited.astype(np.uint8), 'diagonal': _floats(model.diagonal),
                'constraints': np.zeros(len(edges), np.int32)}
        self._cloth = _Cloth(
            nodes=len(model.inverse_masses), edges=len(edges), step=model.step,
            threshold=model.threshold, tolerance=model.tolerance,
            most_iterations=model.most_iterations, forms_matrix=model.forms_matrix,
            gravity=(ctypes.c_float * 3)(*model.gravity),
            **{name: array.ctypes.data for name, array in self._arrays.items()})
        self._held = ctypes.c_int()
        self.iterations = 0
        self.set_state(positions, velocities)

    @property
    def held(self) -> int:
        """Return how many edges were constraints in the last step."""
        return self._held.value

    def set_state(self, positions: np.ndarray, velocities: np.ndarray) -> None:
        """Replace positions [m] and velocities [m/s], (rows, cols, 3)."""
        self.positions, self.velocities = _floats(positions), _floats(velocities)

    def step(self) -> None:
        """
        Make one step of h.

        :raises MemoryError: when there is no memory for it
        """
        self.iterations = self._library.serial_step(
            ctypes.byref(self._cloth), self.positions.ctypes.data, self.velocities.ctypes.data,
            ctypes.byref(self._held))
        if self.iterations < 0:
            raise MemoryError('no memory for the constraints of the serial program')

    def finish(self) -> None:
        """Do nothing: a step ends when it returns."""

    def close(self) -> None:
        """Do nothing: there is nothing on a device."""


class _Cloth(ctypes.Structure):
    """``Cloth`` of serial_cloth.c."""

    _fields_ = [
        ('nodes', ctypes.c_int), ('edges', ctypes.c_int),
        *((name, ctypes.c_void_p) for name in (
            'first', 'second', 'rest', 'stiffness', 'damping', 'inverse_mass', 'diagonal',
            'limited', 'force', 'constraints')),
        ('gravity', ctypes.c_float * 3), ('step', ctypes.c_float),
        ('threshold', ctypes.c_float), ('tolerance', ctypes.c_float),
        ('most_iterations', ctypes.c_int), ('forms_matrix', ctypes.c_int)]


@cache
def compiled_library() -> ctypes.CDLL | None:
    """Return the compiled program; None where no compiler works."""
    compiler = next(filter(None, map(
        shutil.which, filter(None, (os.environ.get('CC'), *_COMPILERS)))), None)
    if compiler is None:
        return None
    with TemporaryDirectory() as folder:
        target = Path(folder) / 'serial_cloth.so'
        try:
            subprocess.run(
                [compiler, *_FLAGS, '-o', target, _SOURCE, '-lm'], check=True,
                capture_output=True, timeout=_COMPILE_SECONDS)
            # It stays loaded when the file is gone.
            library = ctypes.CDLL(str(target))
        except (OSError, subprocess.SubprocessError):
            return None
    library.serial_step.argtypes = [ctypes.POINTER(_Cloth), *3 * [ctypes.c_void_p]]
    library.serial_step.restype = ctypes.c_int
    return library


def _floats(values: np.ndarray) -> np.ndarray:
    return np.array(values, np.float32, order='C')
