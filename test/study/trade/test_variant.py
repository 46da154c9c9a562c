# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A changed scene is the same cloth, but for what was changed."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.trade.variant import Variant
import pytest

GIVEN = {
    'rows': 9, 'cols': 17, 'pins': ['0,0', 'top_right', '8,16', '0,1'], 'node_mass': 0.01,
    'stiffness.bend': 3.0, 'damping.bend': 0.2, 'pin_moves.start': [0.1],
    'pin_moves.node': ['8,16'], 'pin_moves.target': [0.0, 0.0, 2.0]}


def test_the_scene_itself_stays():
    """The scene would be measured in another form than the one that was given."""
    scene = Scene(GIVEN)
    assert Scene(Variant().values(scene)).values == scene.values
    assert Variant().name == 'the scene'


@pytest.mark.parametrize('factor, rows, cols', [(0.5, 5, 9), (2.0, 17, 33), (0.01, 2, 2)])
def test_another_resolution_keeps_size_mass_and_pins(factor, rows, cols):
    """A coarse cloth would be lighter, or held elsewhere."""
    before = Scene(GIVEN)
    after = Scene(Variant(resolution=factor).values(before))
    assert (after.rows, after.cols) == (rows, cols)
    assert after.node_mass * after.node_count == pytest.approx(before.node_mass * 9 * 17)
    pinned = after.pinned_nodes()
    assert pinned[0, 0] and pinned[0, -1] and pinned[-1, -1]
    assert len(after['pins']) == len(set(after['pins']))
    assert after.timed_pin_moves()[0].row == rows - 1


def test_another_stiffness_keeps_the_damping():
    """More than the stiffness would be changed."""
    after = Scene(Variant(stiffness=10.0).values(Scene(GIVEN)))
    assert after.stiffness('bend') == 30.0 and after.stiffness('structural') == 1000.0
    assert after.damping('bend') == 0.2
    assert Variant(stiffness=10.0).name == 'stiffness x 10'
