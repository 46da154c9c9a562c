# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The presets that ship come from a study, which makes them again."""

from pathlib import Path

from cloth_sim_ros.gl.shared_directory import shared_directory
from cloth_sim_ros.sim.given_values import load_parameters
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_fields import PRESETS
from cloth_sim_ros.study.presets import BUDGETS
from cloth_sim_ros.study.trade.choice import read_choice
from cloth_sim_ros.verb.main import main
from made_study import GRID
from made_study import SOFT
import pytest
import yaml

DRAPE = Path(__file__).resolve().parents[2] / 'config' / 'studies' / 'two_corners.yaml'


def test_the_study_writes_presets(tmp_path):
    """A user could not make presets for another machine or scene."""
    methods = {'mass_spring': {**GRID['methods']['mass_spring'], 'over': {'refine': [1, 64, 256]}}}
    grid = {**GRID, 'reference': {**GRID['reference'], 'refine': [64, 128, 256]},
            'methods': methods}
    (tmp_path / 'grid.yaml').write_text(yaml.safe_dump(grid))
    (tmp_path / 'scene.yaml').write_text(yaml.safe_dump({'/**': {'ros__parameters': SOFT}}))
    assert main([
        'study', 'presets', str(tmp_path / 'scene.yaml'), '--grid', str(tmp_path / 'grid.yaml'),
        '--out', str(tmp_path / 'out'), '--jobs', '1']) == 0
    refine = []
    for name in PRESETS:
        path = tmp_path / 'out' / 'presets' / f'{name}.yaml'
        Scene(load_parameters(path))
        values, budget, _ = read_choice(path)
        assert budget == BUDGETS[name]
        refine.append(values['refine'])
    assert refine == sorted(refine) and refine[0] == 1


@pytest.mark.parametrize('name', PRESETS)
def test_shipped_files_tell_the_budget_they_were_chosen_by(name):
    """A preset would claim what it was not chosen for."""
    budget = read_choice(shared_directory('config') / 'presets' / f'{name}.yaml')[1]
    assert budget == BUDGETS[name]


@pytest.mark.long
def test_shipped_presets_keep_to_their_errors(tmp_path, capsys):
    """What a preset says of its error would not be so."""
    for name in PRESETS:
        path = shared_directory('config') / 'presets' / f'{name}.yaml'
        assert main([
            'study', 'tradeoff', str(DRAPE), '--out', str(tmp_path), '--check', str(path)]) == 0
        print(capsys.readouterr().out)
