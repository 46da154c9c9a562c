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

"""The colours of the Gauss-Seidel sweeps."""

from cloth_sim_ros.reference.coloured import coloured_edges
from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest


@pytest.mark.parametrize(('rows', 'cols'), [(5, 6), (6, 5), (1, 7), (7, 1), (2, 2)])
def test_no_node_twice_and_no_edge_left_out(rows, cols):
    """Two edges of one colour share a node, or an edge is in no colour or in two."""
    scene = Scene({'rows': rows, 'cols': cols})
    edges = edges_of(scene)
    colours = coloured_edges(scene, edges)
    assert len(colours) == 16
    for colour in colours:
        nodes = np.concatenate((edges.first[colour], edges.second[colour]))
        assert len(np.unique(nodes)) == len(nodes)
    np.testing.assert_array_equal(
        np.sort(np.concatenate(colours)),
        np.flatnonzero(edges.of(('structural', 'shear'))))
