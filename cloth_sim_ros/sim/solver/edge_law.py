# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
How hard edges pull in the implicit step: hard edges, strain limits and springs by one law.

    lambda(l) = k (l - L0) + k_d dl/dt + (l - l_max) / E    above l_max
                                       + (l - l_min) / E    below l_min

lambda > 0 pulls. A limit comes into force over a transition on either side of it, where what is
beyond it counts as (l - l_max + w)^2 / 4 w. See docs/explanation/implicit_step.md.
"""

from collections.abc import Collection
from dataclasses import dataclass
from dataclasses import replace
from functools import lru_cache
from typing import Any

from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.sim.model.edge_kinds import REST_KINDS
from cloth_sim_ros.sim.model.edge_kinds import rest_lengths
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene

# Weight of the geometric stiffness, over h^2 [1] (Newmark's beta). From 1/4 on, waves across tight
# edges are stable at any h; at 1/4 those much shorter than h change sign in each step, for ever.
BETA = 0.5
# Gravity that the weight of a cloth is taken at [m/s2]: a scene without any has the same law.
STANDARD_GRAVITY = 9.81
# Max. strain of a cloth that hangs by a whole edge, over that of one edge that carries it alone
# [1]; from 34 lines on it makes no difference. A choice of the model: docs/notes/constants.md.
_HANGING_SHARE = 0.03
# Limit of an edge that has none [rest lengths]: beyond any length, below the 3e38 of float32.
FAR = 1e30
# Family of each rest length.
_FAMILY_OF = tuple(FAMILIES.index(kind.family) for kind in REST_KINDS)


@dataclass(frozen=True)
class EdgeLaw:
    """
    The edges of one implicit step. Forces are over the node mass.

    :param length: of the step [s]
    :param stiffness: k [1/s2] along a row, a column, the diagonal, and two along each
    :param damping: k_d of the same [1/s]
    :param shortest: l_min of each family [rest lengths]; far below 0 where there is none
    :param longest: l_max of each family [rest lengths]
    :param limit_stiffness: 1 / E of the same as k [1/s2]
    :param geometric: beta of the geometric mass term; 0 leaves it out
    :param bending: what bending along a row and along a column resists [1/s2]
    :param bending_damping: its damping time [s]
    :param transition: w, the same for all limits [rest lengths], of which no two of an edge are
        nearer than 2 w; 0 for a kink
    :param acts_between_pins: whether an edge pulls, and stores energy, where both ends are pinned
    """

    length: float
    stiffness: tuple[float, ...]
    damping: tuple[float, ...]
    shortest: tuple[float, ...]
    longest: tuple[float, ...]
    limit_stiffness: tuple[float, ...]
    geometric: float = 0.0
    bending: tuple[float, float] = (0.0, 0.0)
    bending_damping: float = 0.0
    transition: float = 0.0
    acts_between_pins: bool = True

    @property
    def bending_weights(self) -> tuple[float, float]:
        """Return what bending along a row and along a column weighs in the matrix."""
        along_row, along_col = self.bending
        weight = BETA * self.length**2
        return weight * along_row, weight * along_col

    @property
    def damping_weights(self) -> tuple[float, float]:
        """Return what the damping of bending weighs there, across the lines that are bent."""
        along_row, along_col = self.bending
        weight = self.length * self.bending_damping
        return weight * along_row, weight * along_col

    @property
    def bending_bounds(self) -> tuple[float, float]:
        """Return what both weigh at most, in any direction."""
        stiff, damped = self.bending_weights, self.damping_weights
        return stiff[0] + damped[0], stiff[1] + damped[1]

    @property
    def weights(self) -> tuple[float, ...]:
        """Return what edges weigh in the matrix along their direction, in order of rest length."""
        return tuple(
            self.length * (self.length * (
                stiffness + (limit if self._has_limit(family) else 0.0)) + damping)
            for family, stiffness, damping, limit in zip(
                _FAMILY_OF, self.stiffness, self.damping, self.limit_stiffness))

    def times(self, mass: float) -> 'EdgeLaw':
        """Return the law with forces in N, of nodes of ``mass`` [kg]."""
        changed: dict[str, Any] = {
            name: tuple(mass * value for value in getattr(self, name))
            for name in ('stiffness', 'damping', 'limit_stiffness', 'bending')}
        return replace(self, **changed)

    @property
    def largest_weight(self) -> float:
        """Return the weight of the heaviest edge."""
        return max(self.weights)

    @property
    def has_bounds(self) -> bool:
        """Return whether there are edges that are hard or come to limits."""
        return any(map(self._has_limit, range(len(FAMILIES))))

    @property
    def has_limits(self) -> bool:
        """Return whether there are edges that come to limits and leave them."""
        return any(
            self._has_limit(family) and least < most
            for family, (least, most) in enumerate(zip(self.shortest, self.longest)))

    def _has_limit(self, family: int) -> bool:
        return self.shortest[family] > 0.0 or self.longest[family] < FAR


# Each snapshot asks for it.
@lru_cache(maxsize=8)
def spring_law(scene: Scene, length: float, *, geometric: float = 0.0) -> EdgeLaw:
    """Return the law of the scene's springs."""
    return edge_law(scene, length, geometric=geometric)


def hard_edges(
        scene: Scene, length: float, *, strain: float = 0.008,
        families: Collection[str] = ('structural', 'shear'), geometric: float = 0.0) -> EdgeLaw:
    """Return the law of edges that keep their rest length, without the others; see edge_law."""
    return edge_law(
        scene, length, hard=families, springs=(), strain=strain, geometric=geometric)


def edge_law(
        scene: Scene, length: float, *, hard: Collection[str] = (),
        springs: Collection[str] = FAMILIES, limited: Collection[str] = (), limit: float = 0.0,
        strain: float = 0.008, transition: float = 0.0, geometric: float = 0.0) -> EdgeLaw:
    """
    Return the law of a step in which families of edges are hard, springs, limited, or left out.

    :param hard: keep their rest length
    :param springs: have the scene's stiffness and damping
    :param limited: have the strain ``limit``
    :param strain: of a hard edge that carries the weight of the cloth, which E follows from
    :param transition: strain from which on, before a limit, it comes into force
    """
    mass = scene.node_mass
    is_spring = [family in springs and family not in hard for family in FAMILIES]
    shortest, longest = [], []
    for family in FAMILIES:
        least, most = -FAR, FAR
        if family in hard:
            least = most = 1.0
        elif family in limited:
            # A length foreseen along a frozen direction can be below 0.
            least, most = 1.0 - limit if limit < 1.0 else -FAR, 1.0 + limit
        shortest.append(least)
        longest.append(most)
    pull = full_pull(scene, strain)
    limits = tuple(pull / (rest * mass) for rest in rest_lengths(scene))
    return EdgeLaw(
        length,
        tuple(kind.stiffness(scene) / mass * is_spring[family]
              for family, kind in zip(_FAMILY_OF, REST_KINDS)),
        tuple(kind.damping(scene) / mass * is_spring[family]
              for family, kind in zip(_FAMILY_OF, REST_KINDS)),
        tuple(shortest), tuple(longest),
        limits, geometric, (scene.bending[0] / mass, scene.bending[1] / mass),
        scene['bending.damping'], transition)


def set_law(program: Program, law: EdgeLaw) -> None:
    """Set the uniforms of solver/edge_law.glsl in the program in use, but for rest lengths."""
    program.set_floats('edge_stiffness', law.stiffness)
    program.set_floats('edge_damping', law.damping)
    program.set_floats('shortest', law.shortest)
    program.set_floats('longest', law.longest)
    program.set_floats('limit_stiffness', law.limit_stiffness)
    program.set_float('transition', law.transition)
    program.set_floats('bending_rate', law.bending)
    program.set_floats('bending_weight', law.bending_weights)


def full_pull(scene: Scene, strain: float) -> float:
    """
    Return L0 / E [N]: what a hard edge would pull with at a strain of 1.

    It goes with the weight of the cloth, so that lengths are held as well whatever a cloth
    weighs, and not with the length of the step, so that energy is a function of the state. A
    corner pin hangs the cloth on an edge or two: one that carries it alone stretches by
    ``strain``. All edges of a chain do so; a cloth of few lines would stretch more than one of
    many when it hangs by a whole edge, so that its edges are harder.
    """
    weight = scene.mass * STANDARD_GRAVITY
    lines = min(scene.spanned)
    return weight / strain * max(1.0, 1.0 / (_HANGING_SHARE * lines))
