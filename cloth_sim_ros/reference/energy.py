# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The energies of a state, in J."""

from collections.abc import Sequence
from dataclasses import dataclass

from cloth_sim_ros.reference.springs import SpringSet
import numpy as np


@dataclass(frozen=True)
class Energies:
    """Kinetic, elastic and gravitational energy [J]; gravitational is zero at the origin."""

    kinetic: float
    elastic: float
    gravitational: float

    @property
    def total(self) -> float:
        """Return the sum of the three [J]."""
        return self.kinetic + self.elastic + self.gravitational


def kinetic_energy(velocities: np.ndarray, free: np.ndarray, node_mass: float) -> float:
    """Return 1/2 m v^2 over the free nodes [J]."""
    return 0.5 * node_mass * float(np.sum(velocities[free] ** 2))


def elastic_energy(springs: Sequence[SpringSet], positions: np.ndarray) -> float:
    """Return 1/2 k (l - L0)^2 over the springs [J]."""
    return sum(
        0.5 * spring_set.stiffness * float(np.sum(
            (spring_set.lengths(positions) - spring_set.rest_length) ** 2))
        for spring_set in springs)


def gravitational_energy(
        positions: np.ndarray, node_mass: float, gravity: np.ndarray) -> float:
    """Return -m g . x over all nodes, the pinned ones too [J]."""
    return -node_mass * float(np.sum(positions @ gravity))
