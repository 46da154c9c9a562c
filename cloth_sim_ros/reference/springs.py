# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The springs of a cloth: six directions, each a slice of the grid; their strain."""

from collections.abc import Sequence
from dataclasses import dataclass

from cloth_sim_ros.sim.materials import WARP
from cloth_sim_ros.sim.materials import WEFT
from cloth_sim_ros.sim.scene import Scene
import numpy as np


@dataclass(frozen=True)
class SpringSet:
    """
    Every spring of one direction: node (r, c) is tied to node (r + down, c + right).

    :param family: structural, shear or bend
    :param rest_length: [m]
    :param stiffness: [N/m]
    :param damping: [N s/m]
    """

    family: str
    down: int
    right: int
    rest_length: float
    stiffness: float
    damping: float

    def ends(self, field: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return views of ``field`` (rows, cols, ...) at the two ends of each spring."""
        rows, cols = field.shape[:2]
        height = max(rows - self.down, 0)
        width = max(cols - abs(self.right), 0)
        left = max(-self.right, 0)
        first = field[:height, left:left + width]
        second = field[self.down:self.down + height,
                       left + self.right:left + self.right + width]
        return first, second

    def lengths(self, positions: np.ndarray) -> np.ndarray:
        """Return the length of each spring [m]."""
        first, second = self.ends(positions)
        return np.linalg.norm(first - second, axis=-1)

    def strains(self, positions: np.ndarray) -> np.ndarray:
        """Return l / L0 - 1 of each spring."""
        return self.lengths(positions) / self.rest_length - 1.0


def spring_sets(scene: Scene, always: Sequence[str] = ()) -> tuple[SpringSet, ...]:
    """
    Return the springs of a scene: the families it models, where its grid has room.

    :param always: families that are there even when the scene gives them no stiffness
    """
    dx, dy = scene.spacing
    diagonal = float(np.hypot(dx, dy))
    directions = (
        ('structural', 0, 1, dx), ('structural', 1, 0, dy),
        ('shear', 1, 1, diagonal), ('shear', 1, -1, diagonal),
        ('bend', 0, 2, 2.0 * dx), ('bend', 2, 0, 2.0 * dy),
    )
    return tuple(
        SpringSet(family, down, right, rest_length,
                  scene.stiffness(family, WARP if right else WEFT),
                  scene.damping(family, WARP if right else WEFT))
        for family, down, right, rest_length in directions
        if (scene.models(family) or family in always)
        and down < scene.rows and abs(right) < scene.cols)


def node_strain(springs: Sequence[SpringSet], positions: np.ndarray) -> np.ndarray:
    """Return the largest |l / L0 - 1| of the structural and shear springs at each node."""
    strain = np.zeros(positions.shape[:2])
    for spring_set in springs:
        if spring_set.family == 'bend':
            continue
        magnitude = np.abs(spring_set.strains(positions))
        for end in spring_set.ends(strain):
            np.maximum(end, magnitude, out=end)
    return strain
