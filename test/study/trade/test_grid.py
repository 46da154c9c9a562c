# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a study of the trade measures: settings and variants, from a YAML file, and its runs."""

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.trade.grid import default_grid_path
from cloth_sim_ros.study.trade.grid import load_grid
from cloth_sim_ros.study.trade.grid import Variant
from cloth_sim_ros.study.trade.measured import own_model
from made_study import GRID
from made_study import small_grid
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


# A grid says what is measured, or what is wrong with it.


def test_the_shipped_grid_can_be_run():
    """A study without --grid would end with an error."""
    grid = load_grid(default_grid_path())
    assert grid.variants[0] == Variant()
    assert {setting.values['mode'] for setting in grid.settings} == {
        'mass_spring', 'constraint', 'adaptive'}
    for setting in grid.settings:
        assert setting.label
        scene = Scene(setting.values)
        # Errors of hard edges against springs would count as those of a way to step them.
        assert own_model(scene) == setting.model
    for moment in (*grid.times, grid.frame):
        for setting in grid.settings:
            steps = moment / setting.values['dt']
            assert abs(steps - round(steps)) < 1e-9


def test_each_combination_is_one_setting():
    """A combination would be left out, or be made twice."""
    method = {'model': 'springs', 'set': {'mode': 'constraint'},
              'over': {'dt': [0.02, 0.01], 'solver.tolerance': [0.1, 0.01, 0.001]}}
    settings = small_grid(methods={'implicit': method}).settings
    assert len({setting.label for setting in settings}) == 6
    assert settings[-1].label == 'dt 0.01 s, tolerance 0.001'
    assert settings[-1].values == {'mode': 'constraint', 'dt': 0.01, 'solver.tolerance': 0.001}


@pytest.mark.parametrize('changes, told', [
    ({'extra': 1}, 'start from'),
    ({'times': 'soon'}, 'is not written as'),
    ({'variants': [{'length': 2.0}]}, 'is not written as'),
    ({'reference': {**GRID['reference'], 'refine': [1, 2]}}, '3 are needed'),
    ({'methods': {'a': {'model': 'rope', 'set': {}, 'over': {}}}}, 'springs, hard, limited'),
    ({'methods': {'a': {'model': 'springs', 'set': {'dtt': 1}, 'over': {}}}}, 'did you mean dt'),
])
def test_what_is_wrong_is_told(changes, told):
    """A mistake in a grid would end in a traceback."""
    with pytest.raises(ClothSimError, match=told):
        small_grid(**changes)


def test_a_missing_file_is_told(tmp_path):
    """A mistyped --grid would end in a traceback."""
    with pytest.raises(ClothSimError, match='cannot be read'):
        load_grid(tmp_path / 'none.yaml')
