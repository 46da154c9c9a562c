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

"""The two rules for substeps against a turning rod and against eigenvalues."""

import math

from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.reference.substeps import geometric_substep
from cloth_sim_ros.reference.substeps import turn_substep
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest


def test_turn_of_a_rod():
    """The turning rate is not the speed across the edge over its length."""
    edges = edges_of(Scene({'rows': 2, 'cols': 1, 'height': 0.5}))
    positions = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.5]])
    velocities = np.array([[0.3, 0.0, 7.0], [0.0, -0.4, 3.0]])
    h = turn_substep(edges, positions, velocities)
    assert (0.5 / 0.5 * h)**2 / 2.0 == pytest.approx(0.005)
    assert turn_substep(edges, positions, np.zeros((2, 3))) == math.inf


def geometric_limit(edges, tension, inverse_masses):
    """Return 2 / sqrt(lambda_max(M^-1 K_geo)) from the dense matrix [s]."""
    stiffness = np.zeros((len(inverse_masses),) * 2)
    for i, j, value in zip(edges.first, edges.second, tension / edges.rest_length):
        stiffness[[i, j], [i, j]] += value
        stiffness[[i, j], [j, i]] -= value
    root = np.sqrt(inverse_masses)
    return 2.0 / math.sqrt(np.linalg.eigvalsh(root[:, None] * stiffness * root)[-1])


def test_the_bound_is_below_the_limit():
    """The bound for each node lets a step pass that the tensions blow up, or is far off."""
    scene = Scene({'rows': 6, 'cols': 7})
    edges = edges_of(scene)
    inverse_masses = ~scene.pinned_nodes().ravel() / scene.node_mass
    for seed in range(5):
        tension = np.random.default_rng(seed).exponential(1.0, len(edges))
        limit = geometric_limit(edges, tension, inverse_masses)
        bound = geometric_substep(edges, tension, inverse_masses)
        assert 0.5 * limit < bound <= limit
    assert geometric_substep(edges, -tension, inverse_masses) == math.inf
