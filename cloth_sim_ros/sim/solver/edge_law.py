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

from dataclasses import dataclass

from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene

# Of the unregularised constraint, which is singular: docs/numerics.md.
DELTA = 1e-3


@dataclass(frozen=True)
class EdgeLaw:
    """
    The edges of one implicit step. All figures are over the node mass.

    :param length: of the step [s]
    :param weights: a of the matrix between two free nodes, for each family
    :param pulls: of the right side, on the extension [1/s], for each family
    :param pinned_weight: what an edge to a pinned node weighs and pulls, over one between two free
    """

    length: float
    weights: tuple[float, float, float]
    pulls: tuple[float, float, float]
    pinned_weight: float

    @property
    def largest_weight(self) -> float:
        """Return the weight of the heaviest edge."""
        return max(self.weights) * max(self.pinned_weight, 1.0)


def implicit_springs(scene: Scene, length: float) -> EdgeLaw:
    """Return the law of the scene's springs, taken implicitly: a = k h^2 + k_d h."""
    stiffness = [scene.stiffness(family) / scene.node_mass for family in FAMILIES]
    damping = [scene.damping(family) / scene.node_mass for family in FAMILIES]
    return EdgeLaw(
        length, tuple(length * (length * k + d) for k, d in zip(stiffness, damping)),
        tuple(length * k for k in stiffness), 1.0)


def hard_edges(
        length: float, *, families: tuple[str, ...] = ('structural', 'shear'),
        delta: float = DELTA) -> EdgeLaw:
    """
    Return the law of edges that keep their rest length: a = 1 / (delta (w_i + w_j)).

    :param delta: regularisation; 1 / delta is about the condition of the system
    """
    weights = tuple(0.5 / delta if family in families else 0.0 for family in FAMILIES)
    return EdgeLaw(length, weights, tuple(weight / length for weight in weights), 2.0)
