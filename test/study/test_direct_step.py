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


"""The direct solve that the benchmark compares with is that of the solver's tests."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import hard_edges
from cloth_sim_ros.sim.solver.edge_law import implicit_springs
from cloth_sim_ros.study.direct_step import direct_step
from implicit_system import ImplicitSystem
from implicit_system import relative_error
import numpy as np
import pytest


@pytest.mark.parametrize('hard', [False, True])
@pytest.mark.parametrize('pins', [['none'], ['top_left', '3,4', '3,5']], ids=['free', 'pinned'])
def test_two_ways_to_the_same_step(hard, pins):
    """An error would be told that is none, or one would pass."""
    scene = Scene({'rows': 8, 'cols': 9, 'pins': pins})
    law = hard_edges(0.01) if hard else implicit_springs(scene, 0.01)
    random = np.random.default_rng(5)
    free = ~scene.pinned_nodes()[..., None]
    shape = (8, 9, 3)
    positions = scene.rest_positions() + 0.01 * random.normal(size=shape)
    velocities = free * random.normal(size=shape)
    expected = ImplicitSystem(scene, law, positions, velocities, scene['gravity']).solve()
    assert relative_error(
        direct_step(scene, law, positions, velocities), expected) < 1e-9
