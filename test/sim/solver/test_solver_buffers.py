# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Levels halve the cloth down to one workgroup, and fit into the buffers of a small device."""

import re

from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.solver.solver_buffers import COARSEST_SIDE
from cloth_sim_ros.sim.solver.solver_buffers import Levels
from cloth_sim_ros.sim.solver.solver_buffers import MOST_TOGETHER
from cloth_sim_ros.sim.solver.solver_buffers import refuse_too_large
import pytest

# What Mesa's llvmpipe allows; GPUs allow as much or more.
COMMON_LIMIT = 2**27


def levels_of(
        rows: int, cols: int, *, coarsen: bool = True, texture: bool = True,
        has_bend: bool = False) -> Levels:
    """Return the levels of a cloth on a software device, or on a GPU."""
    layout = Layout(rows, cols, 'fused', texture, 4, (8, 4))
    return Levels(layout, coarsen=coarsen, has_bend=has_bend)


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


@pytest.mark.parametrize(('shape', 'first'), [
    ((8, 8), 1), ((64, 64), 1), ((65, 65), 1), ((128, 128), 2), ((300, 40), 2), ((1024, 1024), 5)])
def test_levels_of_one_workgroup_fit_its_memory(shape, first):
    """A GPU would refuse the shader, or dispatch passes over a handful of nodes."""
    levels = levels_of(*shape)
    nodes = [layout.rows * layout.cols for layout in levels.layouts]
    assert levels.first_together == first
    assert sum(nodes[first:]) <= MOST_TOGETHER
    assert first == 1 or sum(nodes[first - 1:]) > MOST_TOGETHER


def fields_bytes(levels: Levels, of_cloth: int, of_coarse: int) -> int:
    """Return what as many fields of four float32 on each level take."""
    cloth, *coarse = [16 * layout.stored for layout in levels.layouts]
    return of_cloth * cloth + of_coarse * sum(coarse)


@pytest.mark.parametrize('shape', [(40, 50), (1, 9)])
@pytest.mark.parametrize(('has_bend', 'of_cloth'), [(False, 7), (True, 9)])
def test_buffers_hold_all_fields_and_no_more(shape, has_bend, of_cloth):
    """A field would lie beyond its buffer, or the largest cloth be smaller than it need be."""
    levels = levels_of(*shape, has_bend=has_bend)
    assert levels.vector_bytes == fields_bytes(levels, 9, 3)
    assert levels.system_bytes == fields_bytes(levels, of_cloth, 10)


@pytest.mark.parametrize('texture', [True, False])
@pytest.mark.parametrize(('side', 'has_bend'), [(890, False), (815, True)])
def test_800000_nodes_fit_the_common_buffer_limit(side, has_bend, texture):
    """A cloth that this solver is meant for would be refused."""
    # A field of a level has a quarter of the nodes above: 10 fields of all coarse ones are 3 1/3.
    fields = (9 if has_bend else 7) + 10 / 3
    assert side**2 * fields * 16 < 0.99 * COMMON_LIMIT
    refuse_too_large(levels_of(side, side, texture=texture, has_bend=has_bend), COMMON_LIMIT)


@pytest.mark.parametrize('has_bend', [False, True])
def test_cloth_beyond_the_buffer_limit_is_refused(has_bend):
    """The device would cut the system off, and the cloth would fly apart."""
    with pytest.raises(DeviceError, match='rows 2000 x cols 2000.*use up to about') as refused:
        refuse_too_large(levels_of(2000, 2000, has_bend=has_bend), COMMON_LIMIT)
    rows, cols = re.search(r'up to about (\d+) x (\d+)', str(refused.value)).groups()
    side = int(rows)
    assert rows == cols
    # What is advised fits, to the ghosts at the edges, and is not much too small.
    refuse_too_large(levels_of(side - 10, side - 10, has_bend=has_bend), COMMON_LIMIT)
    with pytest.raises(DeviceError):
        refuse_too_large(levels_of(side + 10, side + 10, has_bend=has_bend), COMMON_LIMIT)
