# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the scenes of comparison.py have in common in all simulators."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

GRAVITY = 9.81
THICKNESS = 0.002  # of a sheet [m]
# A sheet hangs between two pads that hold its first two rows, half its thickness apart.
NODES, SIDE, TOP = 13, 0.12, 0.5
HELD_ROWS = 2
GAP = 0.5 * THICKNESS
PAD = (0.2, 0.05, 0.04)  # sizes [m]
CELL = SIDE / (NODES - 1)
# A sheet is thrown on a free box in space.
THROWN_SIDE, THROWN_MASS, THROWN_SPEED = 0.4, 0.04, 1.0  # [m, kg, m/s]
BOX, BOX_MASS = (0.5, 0.5, 0.1), 1.0


@dataclass(frozen=True)
class Grip:
    """
    How a sheet is held.

    :param mass: of the sheet [kg]
    :param friction: mu
    :param normal: force of a pad on each node, where a simulator can set it [N]
    """

    mass: float
    friction: float
    normal: float


class Pinched(Protocol):
    """A sheet between two pads."""

    def advance(self, end: float) -> None:
        """Simulate up to ``end`` [s]."""

    def positions(self) -> np.ndarray:
        """Return where the nodes are, the upper row first, (nodes, nodes, 3) [m]."""

    def lift(self) -> float | None:
        """Return the vertical force of the pads on the sheet [N]; None if it isn't reported."""


class Thrown(Protocol):
    """A sheet that hits a box."""

    def advance(self, end: float) -> None:
        """Simulate up to ``end`` [s]."""

    def positions(self) -> np.ndarray:
        """Return where the nodes are, (nodes, nodes, 3) [m]."""

    def momenta(self) -> tuple[float, float]:
        """Return the vertical momentum of the sheet, and what the box has got [N s]."""


def hanging() -> np.ndarray:
    """Return where a sheet begins that hangs from its upper edge, (nodes, nodes, 3) [m]."""
    row, col = np.indices((NODES, NODES))
    return np.stack([
        CELL * col - 0.5 * SIDE, np.zeros((NODES, NODES)), TOP - CELL * row], axis=-1)


def level(nodes: int) -> np.ndarray:
    """Return where a sheet begins that is thrown down, 1 cm above the box, (n, n, 3) [m]."""
    row, col = np.indices((nodes, nodes))
    cell = THROWN_SIDE / (nodes - 1)
    return np.stack([
        cell * col - 0.5 * THROWN_SIDE, 0.5 * THROWN_SIDE - cell * row,
        np.full((nodes, nodes), 0.01)], axis=-1)


def pad_center(side: float) -> tuple[float, float, float]:
    """Return the middle of the pad on a side, -1.0 or 1.0 [m]."""
    return 0.0, side * 0.5 * (GAP + PAD[1]), TOP - 0.5 * CELL
