# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""What an edge weighs in the implicit step, and how hard it pulls back to its rest length."""

from collections.abc import Collection
from dataclasses import dataclass

from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene

# Of the unregularised constraint, which is singular: docs/numerics.md.
DELTA = 1e-3
# Of a hard edge's weight: that with which an edge without a spring begins to harden.
_SOFTEST = 1e-5


@dataclass(frozen=True)
class EdgeLaw:
    """
    The edges of one implicit step. Tuples have a figure for each family, over the node mass.

    :param length: of the step [s]
    :param weights: a of the matrix between two free nodes
    :param pulls: of the right side, on the extension [1/s]
    :param pinned_weights: what an edge to a pinned node weighs and pulls, over one between two
        free ones
    :param keeps: share of the tension found so far that a further solve of the same step keeps:
        1 for hard edges, whose tension is whatever it takes, 0 for springs
    :param lags: damping over the length of the step [1/s2], 0 for hard edges
    """

    length: float
    weights: tuple[float, ...]
    pulls: tuple[float, ...]
    pinned_weights: tuple[float, ...]
    keeps: tuple[float, ...]
    lags: tuple[float, ...]

    @property
    def stiffnesses(self) -> tuple[float, ...]:
        """Return the stiffness over the node mass between two free nodes [1/s2]."""
        return tuple(pull / self.length for pull in self.pulls)

    @property
    def largest_weight(self) -> float:
        """Return the weight of the heaviest edge."""
        return max(
            weight * max(factor, 1.0)
            for weight, factor in zip(self.weights, self.pinned_weights))


def edge_law(
        scene: Scene, length: float, *, hard: Collection[str] = (),
        springs: Collection[str] = FAMILIES, delta: float = DELTA,
        hardness: float = 1.0) -> EdgeLaw:
    """
    Return the law of a step in which families of edges are hard, springs, or left out.

    :param hard: keep their rest length: a = 1 / (delta (w_i + w_j))
    :param springs: have the scene's stiffness and damping, taken implicitly: a = k h^2 + k_d h
    :param delta: regularisation; 1 / delta is about the condition of the system
    :param hardness: below 1 hard edges are springs yet, from the scene's stiffness at 0 to hard
    """
    edges = []
    for family in FAMILIES:
        if family in hard and hardness < 1.0:
            edges.append(_hardening(scene, family, length, delta, hardness))
        elif family in hard:
            edges.append(_hard(length, delta))
        elif family in springs:
            edges.append(_spring(scene, family, length))
        else:
            edges.append(_NO_EDGE)
    return EdgeLaw(length, *zip(*edges))


def implicit_springs(scene: Scene, length: float) -> EdgeLaw:
    """Return the law of the scene's springs, taken implicitly."""
    return edge_law(scene, length)


def hard_edges(
        length: float, *, families: Collection[str] = ('structural', 'shear'),
        delta: float = DELTA) -> EdgeLaw:
    """Return the law of edges that keep their rest length, without the others."""
    return EdgeLaw(length, *zip(*(
        _hard(length, delta) if family in families else _NO_EDGE for family in FAMILIES)))


# Weight, pull, weight of pinned ones, keep and lag, as in EdgeLaw.
_NO_EDGE = (0.0, 0.0, 1.0, 0.0, 0.0)


def _hard(length: float, delta: float) -> tuple[float, ...]:
    return 0.5 / delta, 0.5 / (delta * length), 2.0, 1.0, 0.0


def _hardening(
        scene: Scene, family: str, length: float, delta: float,
        hardness: float) -> tuple[float, ...]:
    last = 0.5 / delta
    first = max(length**2 * scene.stiffness(family) / scene.node_mass, _SOFTEST * last)
    weight = min(first**(1.0 - hardness) * last**hardness, last)
    return weight, weight / length, 1.0, 0.0, 0.0


def _spring(scene: Scene, family: str, length: float) -> tuple[float, ...]:
    k, d = (value / scene.node_mass for value in (scene.stiffness(family), scene.damping(family)))
    return length * (length * k + d), length * k, 1.0, 0.0, d / length
