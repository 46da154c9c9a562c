# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloth in NumPy: slices of whole arrays, each spring evaluated once."""

from cloth_sim_ros.reference.edges import SpringSet
import numpy as np
from peers.cloth import Cloth
from peers.cloth import LEAST_SQUARE


class NumpyCloth:
    """Planes of float32, (3, rows, cols)."""

    def __init__(self, cloth: Cloth) -> None:
        """Copy the start."""
        self._cloth = cloth
        self._positions = np.ascontiguousarray(np.moveaxis(cloth.start, -1, 0), np.float32)
        self._velocities = np.zeros_like(self._positions)
        self._forces = np.zeros_like(self._positions)
        self._kick = (cloth.dt / cloth.node_mass * cloth.free).astype(np.float32)
        self._fall = (
            cloth.dt * cloth.gravity[:, None, None] * cloth.free).astype(np.float32)

    def step(self, count: int) -> None:
        """Make ``count`` steps of dt."""
        for _ in range(count):
            self._find_forces()
            self._velocities += self._fall + self._kick * self._forces
            self._positions += np.float32(self._cloth.dt) * self._velocities

    def positions(self) -> np.ndarray:
        """Return where the nodes are, (rows, cols, 3) [m]."""
        return np.moveaxis(self._positions, 0, -1).copy()

    def _find_forces(self) -> None:
        self._forces[:] = 0.0
        for spring in self._cloth.springs:
            first, second = self._ends(spring, self._positions)
            d = second - first
            first, second = self._ends(spring, self._velocities)
            dv = second - first
            square = np.maximum(np.einsum('kij,kij->ij', d, d), np.float32(LEAST_SQUARE))
            inverse = 1.0 / np.sqrt(square)
            rate = np.einsum('kij,kij->ij', d, dv) * inverse
            pull = np.float32(spring.stiffness) - inverse * (
                np.float32(spring.stiffness * spring.rest_length)
                - np.float32(spring.damping) * rate)
            d *= pull
            first, second = self._ends(spring, self._forces)
            first += d
            second -= d

    @staticmethod
    def _ends(spring: SpringSet, planes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        first, second = spring.ends(np.moveaxis(planes, 0, -1))
        return np.moveaxis(first, -1, 0), np.moveaxis(second, -1, 0)
