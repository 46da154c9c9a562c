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

"""Levels halve the cloth down to one workgroup, and fit into the buffers of a small device."""

from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.solver.levels import COARSEST_SIDE
from cloth_sim_ros.sim.solver.levels import Levels
from cloth_sim_ros.sim.solver.solver_buffers import refuse_too_large
import pytest

# What Mesa's llvmpipe allows; GPUs allow as much or more.
COMMON_LIMIT = 2**27


def levels_of(rows: int, cols: int, *, coarsen: bool = True, texture: bool = True) -> Levels:
    """Return the levels of a cloth on a software device, or on a GPU."""
    return Levels(Layout(rows, cols, 'fused', texture, 4, (8, 4)), coarsen=coarsen)


@pytest.mark.parametrize(('shape', 'sizes'), [
    ((2, 2), [(2, 2), (1, 1)]),
    ((8, 8), [(8, 8), (4, 4)]),
    ((33, 17), [(33, 17), (17, 9), (9, 5), (5, 3)]),
    ((1, 40), [(1, 40), (1, 20), (1, 10), (1, 5)]),
])
def test_each_level_has_half_the_nodes_along_a_side(shape, sizes):
    """A level would miss nodes, or the coarsest would not fit into a workgroup."""
    layouts = levels_of(*shape).layouts
    assert [(layout.rows, layout.cols) for layout in layouts] == sizes
    assert max(sizes[-1]) <= COARSEST_SIDE


def test_without_coarsening_there_is_the_cloth_alone():
    """Block-Jacobi would pay for levels it does not use."""
    assert len(levels_of(64, 64, coarsen=False).layouts) == 1


@pytest.mark.parametrize('texture', [True, False])
def test_a_million_nodes_fit_into_the_common_limit(texture):
    """The largest cloth this solver is meant for would be refused."""
    refuse_too_large(levels_of(1024, 1024, texture=texture), COMMON_LIMIT)


def test_a_cloth_beyond_the_buffers_is_refused_with_the_limit():
    """The device would cut the system off, and the cloth would fly apart."""
    with pytest.raises(DeviceError, match='rows 2000 x cols 2000.*use up to about 10[0-9]+ x 10'):
        refuse_too_large(levels_of(2000, 2000), COMMON_LIMIT)
