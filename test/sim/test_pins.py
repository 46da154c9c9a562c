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

"""Pin names hold the nodes they name."""

from cloth_sim_ros.sim.pins import pinned_nodes
import numpy as np
import pytest


@pytest.mark.parametrize(('names', 'nodes'), [
    (['none'], []),
    ([], []),
    (['top_left', 'bottom_right'], [(0, 0), (2, 3)]),
    (['top_right', 'bottom_left'], [(0, 3), (2, 0)]),
    (['top_edge'], [(0, 0), (0, 1), (0, 2), (0, 3)]),
    (['bottom_edge'], [(2, 0), (2, 1), (2, 2), (2, 3)]),
    (['1,2', ' 2 , 0 '], [(1, 2), (2, 0)]),
])
def test_names_and_nodes(names: list[str], nodes: list[tuple[int, int]]):
    """The cloth would hang from other nodes than the scene says."""
    assert {tuple(node) for node in np.argwhere(pinned_nodes(names, 3, 4))} == set(nodes)


def test_all_nodes():
    """A cloth that is to be held everywhere would fall."""
    assert pinned_nodes(['all'], 3, 4).all()
