# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The direct solve that the benchmark compares with is that of the solver's tests."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import edge_law
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import hard_edges
from cloth_sim_ros.sim.solver.edge_law import spring_law
from cloth_sim_ros.study.direct_step import direct_step
from implicit_system import ImplicitSystem
from implicit_system import relative_error
import numpy as np
import pytest
from springs import SPRINGS


def laws(scene: Scene) -> dict[str, EdgeLaw]:
    """Return a law of each kind."""
    return {
        'springs': spring_law(scene, 0.01),
        'hard': hard_edges(scene, 0.01),
        'limited': edge_law(scene, 0.01, limited=('structural', 'shear'), limit=0.05)}


@pytest.mark.parametrize('kind', ['springs', 'hard', 'limited'])
@pytest.mark.parametrize('shape', [(8, 9), (1, 7), (7, 1)])
@pytest.mark.parametrize('is_held', [False, True])
def test_two_ways_to_the_same_step(kind, shape, is_held):
    """An error would be told that is none, or one would pass."""
    rows, cols = shape
    # Two pins with an edge between them, and one apart.
    pins = ['0,0', '0,1' if cols > 1 else '1,0', 'bottom_right'] if is_held else ['none']
    scene = Scene({**SPRINGS, 'rows': rows, 'cols': cols, 'height': 0.7, 'pins': pins})
    law = laws(scene)[kind]
    random = np.random.default_rng(5)
    free = ~scene.pinned_nodes()[..., None]
    positions = scene.rest_positions() + 0.01 * random.normal(size=(rows, cols, 3))
    velocities = free * random.normal(size=(rows, cols, 3))
    expected = ImplicitSystem(scene, law, positions, velocities, scene['gravity']).solve()
    assert relative_error(
        direct_step(scene, law, positions, velocities), expected) < 1e-9
