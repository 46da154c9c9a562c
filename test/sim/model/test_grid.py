# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which node a point means."""

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.grid import near_node
from cloth_sim_ros.sim.model.grid import usual_reach
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest
from springs import SPRINGS


def test_tells_the_distance():
    """A caller could not see whether a node was hit or only the nearest."""
    positions = np.zeros((2, 3, 3), np.float32)
    positions[..., 0] = np.arange(3)
    positions[..., 1] = np.arange(2)[:, None]
    found = near_node(positions, (2.3, 1.4, 0.0), 0.6)
    assert (found.row, found.col) == (1, 2)
    assert found.distance == pytest.approx(0.5)
    with pytest.raises(ClothSimError, match=r'within 0.4 m.*\(1, 2\), is 0.5 m away'):
        near_node(positions, (2.3, 1.4, 0.0), 0.4)


@pytest.mark.parametrize('shape, reach', [
    ({'rows': 41, 'cols': 41}, 0.1), ({'rows': 3, 'cols': 6}, 0.5),
    ({'rows': 1, 'cols': 51}, 0.1), ({'rows': 5, 'cols': 1}, 0.25)], ids=str)
def test_a_point_on_the_cloth_is_in_reach(shape, reach):
    """A point between the nodes of a coarse cloth would mean none of them."""
    scene = Scene({**SPRINGS, **shape, 'pins': []})
    assert usual_reach(scene.rows, scene.cols, scene.spacing) == pytest.approx(reach)


@pytest.mark.parametrize('point', [
    (0.0, 0.0), (float('nan'), 0.0, 0.0), (0.0, float('inf'), 0.0), (0.0, 0.0, 1e200)])
def test_a_point_that_is_none_is_refused(point: tuple[float, ...]):
    """The node nearest to nowhere would be pinned, or a square leave the range of a float."""
    scene = Scene({**SPRINGS, 'rows': 3, 'cols': 3})
    with pytest.raises(ClothSimError, match='a point must be .*: (give|keep) '):
        near_node(scene.rest_positions(), point, 0.5)
