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

"""The rule for substeps against a turning rod."""

import math

from cloth_sim_ros.reference.edges import edges_of
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
    assert (0.5 / 0.5 * h)**2 / 2.0 == pytest.approx(0.0025)
    assert turn_substep(edges, positions, np.zeros((2, 3))) == math.inf
