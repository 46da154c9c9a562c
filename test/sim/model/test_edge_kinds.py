# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which nodes the edges join."""

from cloth_sim_ros.reference.edges import spring_sets
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.model.edge_kinds import edges_at
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest
from springs import SPRINGS

SHAPES = [(5, 7), (2, 2), (1, 6), (6, 1), (2, 3)]


def number_nodes(rows, cols):
    """Return a (rows, cols) array with a number for each node."""
    return np.arange(rows * cols).reshape(rows, cols)


@pytest.mark.parametrize(('rows', 'cols'), SHAPES)
def test_edges_are_the_springs_of_the_reference(rows, cols):
    """A tension would be reported for a missing edge, or for another one."""
    scene = Scene({**SPRINGS, 'rows': rows, 'cols': cols, 'width': 0.3, 'height': 0.5})
    nodes = number_nodes(rows, cols)
    springs = {
        (springs.family, springs.down, springs.right): springs
        for springs in spring_sets(scene, always=FAMILIES)}
    for kind in EDGE_KINDS:
        starts, ends = kind.everywhere(rows, cols)
        key = (kind.family, kind.drow, kind.dcol)
        if key not in springs:
            assert nodes[starts].size == 0
            continue
        first, second = springs[key].ends(nodes)
        np.testing.assert_array_equal(nodes[starts], first)
        np.testing.assert_array_equal(nodes[ends], second)
        assert kind.rest_length(scene) == pytest.approx(springs[key].rest_length)


@pytest.mark.parametrize(('rows', 'cols'), SHAPES)
def test_edges_at_a_node_are_those_with_an_end_there(rows, cols):
    """A pin would not feel one of its edges, or feel one of another node."""
    nodes = number_nodes(rows, cols)
    chosen = np.array([(0, 0), (rows - 1, cols // 2)])
    numbers = nodes[tuple(chosen.T)]
    edges = edges_at(chosen, rows, cols)
    found = list(zip(
        *(nodes[tuple(ends)].tolist() for ends in (edges.starts, edges.ends, edges.others)),
        numbers[edges.nodes].tolist(), edges.kinds.tolist()))
    for kind in EDGE_KINDS:
        every = {
            (int(a), int(b)) for a, b in zip(
                *(nodes[index].ravel() for index in kind.everywhere(rows, cols)))}
        assert sorted(entry[:4] for entry in found if entry[4] == kind.number) == sorted(
            (a, b, b if number == a else a, number)
            for a, b in every for number in numbers.tolist() if number in (a, b))
