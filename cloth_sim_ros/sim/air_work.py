# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The work of the air on a cloth, for those who keep accounts of its energy."""

from cloth_sim_ros.sim.state import State
import numpy as np


class AirWork:
    """
    Adds up what the accelerations in force do as the free nodes move.

    Reads positions and accelerations back at each look of the air, which is slow.

    :param node_mass: [kg]
    """

    def __init__(self, node_mass: float) -> None:
        """Begin with nothing done."""
        self._node_mass = node_mass
        self._done = 0.0
        self._positions: np.ndarray | None = None
        self._accelerations: np.ndarray | None = None

    def settle(self, state: State) -> float:
        """Return the work until the present ``state`` [J]."""
        if self._positions is not None:
            positions = state.read_positions().astype(float)
            moved = (positions - self._positions) * ~state.pinned[..., None]
            self._done += self._node_mass * float(np.sum(self._accelerations * moved))
            self._positions = positions
        return self._done

    def take(self, state: State, accelerations: np.ndarray) -> None:
        """Take ``accelerations`` (rows, cols, 3) [m/s2] for those in force from now on."""
        self.settle(state)
        self._positions = state.read_positions().astype(float)
        self._accelerations = accelerations
