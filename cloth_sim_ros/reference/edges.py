# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The springs of a cloth, as six slices of the grid and as one flat list of edges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from dataclasses import fields
from typing import Any

from cloth_sim_ros.reference.cells import spring_shares
from cloth_sim_ros.sim.model.materials import WARP
from cloth_sim_ros.sim.model.materials import WEFT
from cloth_sim_ros.sim.scene import Scene
import numpy as np
from scipy import sparse


@dataclass(frozen=True)
class SpringSet:
    """
    Every spring of one direction: node (r, c) is tied to node (r + down, c + right).

    :param family: structural, shear or bend
    :param rest_length: [m]
    :param stiffness: of a whole line [N/m]
    :param damping: of a whole line [N s/m]
    :param shares: of these that each spring has, (rows, cols) of the first ends
    """

    family: str
    down: int
    right: int
    rest_length: float
    stiffness: float
    damping: float
    shares: np.ndarray

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
                  scene.damping(family, WARP if right else WEFT),
                  spring_shares(scene, down, right))
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


@dataclass(frozen=True)
class Edges:
    """
    Edges between nodes numbered row by row; fields of nodes are (nodes, 3).

    :param first: node of each edge at its upper end
    :param second: node at its other end
    :param rest_length: [m]
    :param stiffness: [N/m]
    :param damping: [N s/m]
    :param family: structural, shear or bend, of each edge
    :param share: of a whole line
    """

    first: np.ndarray
    second: np.ndarray
    rest_length: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    family: np.ndarray
    share: np.ndarray

    def __len__(self) -> int:
        """Return the number of edges."""
        return len(self.first)

    def of(self, families: Sequence[str]) -> np.ndarray:
        """Return which edges belong to ``families``, bool."""
        return np.isin(self.family, families)

    def only(self, families: Sequence[str]) -> Edges:
        """Return the edges that belong to ``families``, in the same order."""
        return self.where(self.of(families))

    def where(self, chosen: np.ndarray) -> Edges:
        """Return the ``chosen`` edges, bool, in the same order."""
        return Edges(*(getattr(self, field.name)[chosen] for field in fields(self)))

    def differences(self, field: np.ndarray) -> np.ndarray:
        """Return the field at the first end less that at the second."""
        return field[self.first] - field[self.second]

    def lengths(self, positions: np.ndarray) -> np.ndarray:
        """Return the length of each edge [m]."""
        return np.linalg.norm(self.differences(positions), axis=1)

    def strains(self, positions: np.ndarray) -> np.ndarray:
        """Return l / L0 - 1 of each edge."""
        return self.lengths(positions) / self.rest_length - 1.0

    def directions(self, positions: np.ndarray) -> np.ndarray:
        """Return the unit vector to the first end; 0 where an edge has no length."""
        return _along(self.differences(positions))[1]

    def along(self, velocities: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """Return how fast each edge grows [m/s]."""
        return np.sum(self.differences(velocities) * directions, axis=1)

    def across(self, velocities: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """Return the velocity of the first end past the second, across the edge [m/s]."""
        rates = self.differences(velocities)
        return rates - np.sum(rates * directions, axis=1, keepdims=True) * directions

    def scatter(self, vectors: np.ndarray, nodes: int) -> np.ndarray:
        """Return at each node what its edges give: ``vectors`` to the first, - to the second."""
        return np.stack([
            np.bincount(self.first, weights=component, minlength=nodes)
            - np.bincount(self.second, weights=component, minlength=nodes)
            for component in vectors.T], axis=1, dtype=float)

    def spring_forces(self, positions: np.ndarray, velocities: np.ndarray) -> np.ndarray:
        """Return the forces of the edges, as damped springs, on each node [N]."""
        lengths, directions = _along(self.differences(positions))
        rates = np.einsum('ij,ij->i', self.differences(velocities), directions)
        tensions = self.stiffness * (lengths - self.rest_length) + self.damping * rates
        return self.scatter(-tensions[:, None] * directions, len(positions))

    def jacobian(self, directions: np.ndarray, nodes: int) -> sparse.csr_matrix:
        """Return J, edges x 3 nodes: J v is the rate at which each edge grows."""
        rows = np.repeat(np.arange(len(self)), 3)
        columns = [3 * end[:, None] + np.arange(3) for end in (self.first, self.second)]
        return sparse.csr_matrix(
            (np.concatenate((directions.ravel(), -directions.ravel())),
             (np.tile(rows, 2), np.concatenate([column.ravel() for column in columns]))),
            shape=(len(self), 3 * nodes))


def _along(differences: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return lengths and unit vectors; 0 for what has no length, which pulls nowhere."""
    lengths = np.sqrt(np.einsum('ij,ij->i', differences, differences))
    divisors = np.where(lengths > 0.0, lengths, 1.0)
    return lengths, differences / divisors[:, None]


def edges_of(scene: Scene, always: Sequence[str] = ()) -> Edges:
    """
    Return the edges of a scene, in the order of ``spring_sets``.

    :param always: families that are there even when the scene gives them no stiffness
    """
    numbers = np.arange(scene.node_count).reshape(scene.rows, scene.cols)
    columns: list[list[np.ndarray]] = [[] for _ in range(7)]
    for springs in spring_sets(scene, always):
        first, second = (end.ravel() for end in springs.ends(numbers))
        row: tuple[Any, ...] = (
            first, second, springs.rest_length, springs.shares.ravel() * springs.stiffness,
            springs.shares.ravel() * springs.damping, springs.family, springs.shares.ravel())
        for column, value in zip(columns, row):
            column.append(np.broadcast_to(value, first.shape))
    if not columns[0]:
        nodes, none = np.zeros(0, int), np.zeros(0)
        return Edges(nodes, nodes, none, none, none, np.zeros(0, 'U10'), none)
    return Edges(*(np.concatenate(column) for column in columns))
