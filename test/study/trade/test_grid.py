# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A grid says what is measured, or what is wrong with it."""

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.trade.grid import default_grid_path
from cloth_sim_ros.study.trade.grid import load_grid
from cloth_sim_ros.study.trade.variant import Variant
from made_study import GRID
from made_study import small_grid
import pytest


def test_the_shipped_grid_can_be_run():
    """A study without --grid would end with an error."""
    grid = load_grid(default_grid_path())
    assert grid.variants[0] == Variant()
    assert {setting.values['mode'] for setting in grid.settings} == {
        'mass_spring', 'constraint', 'adaptive'}
    for setting in grid.settings:
        assert setting.label
        Scene(setting.values)
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
