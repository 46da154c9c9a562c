# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pin names hold the nodes they name."""

from cloth_sim_ros.sim.model.pins import pinned_nodes
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
