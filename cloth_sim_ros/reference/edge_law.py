# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
One law for hard edges, strain limits and implicit springs.

    lambda(l) = k (l - L0) + k_d dl/dt + (l - l_max) / E    above l_max
                                       + (l - l_min) / E    below l_min

lambda > 0 pulls. E is a compliance that belongs to the scene, not to the step: the energy of an
edge is a function of its length, so a change of the step neither makes nor takes any.

A limit comes into force over a transition of w on either side of l_max. There what is beyond it
counts as (l - l_max + w)^2 / (4 w), so that the slope of lambda grows from that of the spring to
that of the limit. For a strain limit, l_max - w is the limit: an edge at it stores nothing there.
"""

from dataclasses import dataclass

from cloth_sim_ros.reference.cells import node_masses
from cloth_sim_ros.reference.edges import Edges
from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# The weight is that on the ground: a scene without gravity has the same E.
STANDARD_GRAVITY = 9.81
# Max. strain of a cloth that hangs by a whole edge, over that of one edge that carries the whole
# weight [1]. A cloth of few lines, which share the load, has a smaller E for it.
WHOLE_EDGE = 0.03
# Families with a strain limit. The length of a bend spring is not a strain of the cloth.
LIMITED = ('structural', 'shear')
# Strain beyond l_max of an edge that carries the whole cloth: as a fraction of the limit, and at
# most [1]. It is half the transition too, which begins at the limit.
BEYOND_LIMIT = 0.1
MOST_BEYOND = 0.002


@dataclass(frozen=True)
class EdgeLaw:
    """
    The tension of each edge as a function of its length; every field has one value an edge.

    :param edges: with their rest lengths
    :param shortest: l_min [m]; minus infinity where there is none: a length that is foreseen along
        a frozen direction can be below 0
    :param longest: l_max [m]; infinite where there is none
    :param stiffness: k [N/m]
    :param damping: k_d [N s/m]
    :param compliance: E [m/N]
    :param transition: w [m]; 0 for hard edges
    """

    edges: Edges
    shortest: np.ndarray
    longest: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    compliance: np.ndarray
    transition: np.ndarray

    def side(self, lengths: np.ndarray) -> np.ndarray:
        """Return which limit pulls: 1 for l_max, -1 for l_min, 0 for none."""
        is_hard = self.shortest == self.longest
        is_long = lengths > self.longest - self.transition
        is_short = lengths < self.shortest + self.transition
        return np.where(is_hard | is_long, 1, -is_short.astype(int))

    def beyond(self, lengths: np.ndarray) -> np.ndarray:
        """Return how far ``lengths`` are past their limits, 0 within them [m]."""
        return lengths - np.clip(lengths, self.shortest, self.longest)

    def pull(self, lengths: np.ndarray) -> np.ndarray:
        """Return the limit tensions times E [m]: excess lengths, smoothed by the transition."""
        return (_past(lengths - self.longest, self.transition)
                - _past(self.shortest - lengths, self.transition))

    def tension(self, lengths: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """
        Return lambda [N].

        :param lengths: [m]
        :param rates: dl/dt [m/s]
        """
        elastic = self.stiffness * (lengths - self.edges.rest_length) + self.damping * rates
        return elastic + self.pull(lengths) / self.compliance

    def slope(self, lengths: np.ndarray) -> np.ndarray:
        """Return d lambda / dl [N/m]."""
        in_force = (_slope_past(lengths - self.longest, self.transition)
                    + _slope_past(self.shortest - lengths, self.transition))
        hard = self.shortest == self.longest
        return self.stiffness + np.where(hard, 1.0, in_force) / self.compliance

    def energy(self, lengths: np.ndarray) -> float:
        """Return the energy that edges of these lengths hold [J]."""
        past = (_energy_past(lengths - self.longest, self.transition)
                + _energy_past(self.shortest - lengths, self.transition))
        return self.spring_energy(lengths) + float(np.sum(past / self.compliance))

    def spring_energy(self, lengths: np.ndarray) -> float:
        """Return the part of it that springs hold, without hard edges and limits [J]."""
        extension = lengths - self.edges.rest_length
        return 0.5 * float(np.sum(self.stiffness * extension**2))

    def excess(self, lengths: np.ndarray) -> np.ndarray:
        """Return how far each edge is past its limits, in rest lengths, 0 within them."""
        return np.abs(self.beyond(lengths)) / self.edges.rest_length


def _past(d: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Return the pull of a limit over its stiffness, ``d`` past it, with a transition of ``w``."""
    within = np.clip(d, -w, w) + w
    return np.divide(within**2, 4.0 * w, out=np.zeros_like(d), where=w > 0.0) + np.maximum(
        d - w, 0.0)


def _slope_past(d: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Return its slope, 0 to 1."""
    within = np.clip(d, -w, w) + w
    return np.divide(within, 2.0 * w, out=(d > 0.0).astype(float), where=w > 0.0)


def _energy_past(d: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Return its integral over ``d``."""
    within = np.clip(d, -w, w) + w
    further = np.maximum(d - w, 0.0)
    return (np.divide(within**3, 12.0 * w, out=np.zeros_like(d), where=w > 0.0)
            + further * (w + 0.5 * further))


def constraint_law(scene: Scene) -> EdgeLaw:
    """
    Return the law of mode constraint.

    Families in ``constraint.hard`` keep their length, those in ``constraint.springs`` are springs
    where the scene gives them stiffness or damping, and all others are left out.
    """
    families = scene['constraint.hard']
    springs = [family for family in scene['constraint.springs'] if scene.models(family)]
    edges = edges_of(scene, always=families).only([*families, *springs])
    hard = edges.of(families)
    return EdgeLaw(
        edges, np.where(hard, edges.rest_length, -np.inf),
        np.where(hard, edges.rest_length, np.inf), np.where(hard, 0.0, edges.stiffness),
        np.where(hard, 0.0, edges.damping), limit_compliance(scene, edges),
        np.zeros(len(edges)))


def limited_law(scene: Scene, limit: float | None = None) -> EdgeLaw:
    """
    Return the law of springs whose structural and shear edges have strain limits.

    :param limit: of |l / L0 - 1|; None takes the scene's ``adaptive.threshold``
    :raises ClothSimError: for a limit that is not above 0
    """
    limit = scene['adaptive.threshold'] if limit is None else limit
    if not limit > 0.0:
        raise ClothSimError(
            f'a strain limit must be above 0, got {limit}: take constraint_law for edges that '
            'keep their length')
    edges = edges_of(scene)
    limited = edges.of(LIMITED)
    beyond = strain_past_limit(scene)
    middle = limit + beyond
    return EdgeLaw(
        edges, np.where(limited & (middle < 1.0), edges.rest_length * (1.0 - middle), -np.inf),
        np.where(limited, edges.rest_length * (1.0 + middle), np.inf),
        edges.stiffness, edges.damping, limit_compliance(scene, edges, beyond),
        beyond * edges.rest_length)


def strain_past_limit(scene: Scene) -> float:
    """Return the strain by which an edge that carries the whole cloth passes its limit."""
    return min(BEYOND_LIMIT * scene['adaptive.threshold'], MOST_BEYOND)


def spring_law(scene: Scene) -> EdgeLaw:
    """Return the law of springs alone."""
    edges = edges_of(scene)
    return EdgeLaw(
        edges, np.full(len(edges), -np.inf), np.full(len(edges), np.inf), edges.stiffness,
        edges.damping, limit_compliance(scene, edges), np.zeros(len(edges)))


def limit_compliance(
        scene: Scene, edges: Edges, strain: float | None = None) -> np.ndarray:
    """
    Return E of each edge [m/N].

    An edge that carries the whole cloth, as at a corner, stretches by ``strain`` at most, or by
    the scene's ``constraint.strain`` when that is None. Where n lines share the weight, each
    carries an n-th: few lines have a smaller E, so that they stretch by no more than WHOLE_EDGE of
    that.
    """
    weight = scene.mass * STANDARD_GRAVITY
    there = node_masses(scene) > 0.0
    lines = min(np.ptp(np.nonzero(there), axis=1)) + 1
    strain = scene['constraint.strain'] if strain is None else strain
    hardness = weight / strain * max(1.0, 1.0 / (WHOLE_EDGE * lines))
    # A limit has the share of the stiffness that its spring has, 0 for no edge.
    return np.divide(
        edges.rest_length, hardness * edges.share, out=np.full(len(edges), np.inf),
        where=edges.share > 0.0)
