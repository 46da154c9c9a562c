# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloth that all peers step, in plain values, and what a peer offers."""

from dataclasses import dataclass
from typing import Protocol

from cloth_sim_ros.reference.edges import spring_sets
from cloth_sim_ros.reference.edges import SpringSet
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# Along a row, along a column, both diagonals, two along each: the order of spring_sets.
KINDS = 6
# Below this squared length a spring counts as this long, as in spring_law.glsl [m2].
LEAST_SQUARE = 1e-20


class PeerMissingError(Exception):
    """A peer lacks something on this machine that is no Python module."""


class Peer(Protocol):
    """One implementation with a cloth of its own, made from a ``Cloth``."""

    def step(self, count: int) -> None:
        """Make ``count`` steps of dt, and return when they are done."""

    def positions(self) -> np.ndarray:
        """Return where the nodes are, (rows, cols, 3) [m]."""


@dataclass(frozen=True)
class Cloth:
    """
    A regular grid of springs at rest.

    :param start: positions, (rows, cols, 3) float64 [m]
    :param free: False where a node is pinned, (rows, cols)
    :param springs: the six kinds
    :param node_mass: [kg]
    :param gravity: (3,) [m/s2]
    :param dt: [s], one substep
    """

    scene: Scene
    start: np.ndarray
    free: np.ndarray
    springs: tuple[SpringSet, ...]
    node_mass: float
    gravity: np.ndarray
    dt: float

    def law(self, kick: float = 1.0) -> np.ndarray:
        """
        Return k, k L0 and k_d of the six kinds, each times ``kick``, (3, 6) float32.

        The pull of a spring, over its length l, is k - (k L0 - k_d dl/dt) / l.
        """
        return kick * np.array([
            [spring.stiffness for spring in self.springs],
            [spring.stiffness * spring.rest_length for spring in self.springs],
            [spring.damping for spring in self.springs]]).astype(np.float32)


def cloth_of(scene: Scene) -> Cloth:
    """
    Return the cloth of ``scene``, which has one substep of dt.

    :raises ValueError: for a scene that lacks one of the six kinds of springs
    """
    springs = spring_sets(scene)
    if len(springs) != KINDS:
        raise ValueError(
            f'peers have structural, shear and bend springs both ways, got {len(springs)} of '
            f'{KINDS} kinds: give all three families, and at least 3 nodes along each side')
    return Cloth(
        scene, scene.start_positions(), ~scene.pinned_nodes(), springs, scene.node_mass,
        np.array(scene['gravity']), scene['dt'])
