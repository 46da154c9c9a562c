# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The presets that ship come from a study, which makes them again."""

from pathlib import Path

from cloth_sim_ros.api.scene_file import load_scene
from cloth_sim_ros.gl.shared_directory import shared_directory
from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.model.scene_fields import PRESETS
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.presets import BUDGETS
from cloth_sim_ros.study.trade.choice import read_choice
from cloth_sim_ros.verb.main import main
from made_study import GRID
from made_study import SOFT
import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
USUAL = ['fast', 'balanced', 'accurate']


def shipped(name):
    """Return the path of a preset, and that of the scene it says it was chosen on."""
    path = shared_directory('config') / 'presets' / f'{name}.yaml'
    scene = path.read_text().split(':')[0].removeprefix('# For ')
    return path, ROOT / scene


def test_the_study_writes_presets(tmp_path):
    """A user could not make presets for another machine or scene."""
    methods = {'mass_spring': {**GRID['methods']['mass_spring'], 'over': {'refine': [1, 64, 256]}}}
    grid = {**GRID, 'reference': {**GRID['reference'], 'refine': [64, 128, 256]},
            'methods': methods}
    (tmp_path / 'grid.yaml').write_text(yaml.safe_dump(grid))
    (tmp_path / 'scene.yaml').write_text(yaml.safe_dump({'/**': {'ros__parameters': SOFT}}))
    arguments = [
        'study', 'presets', str(tmp_path / 'scene.yaml'), '--grid', str(tmp_path / 'grid.yaml'),
        '--out', str(tmp_path / 'out'), '--jobs', '1']
    assert main(arguments) == 0
    folder = tmp_path / 'out' / 'presets'
    refine = []
    assert sorted(path.stem for path in folder.iterdir()) == sorted(USUAL)
    for name in USUAL:
        path = folder / f'{name}.yaml'
        Scene(load_parameters(path))
        values, budget, _ = read_choice(path)
        assert budget == BUDGETS[name]
        refine.append(values['refine'])
    assert refine == sorted(refine) and refine[0] == 1
    assert main([*arguments, '--only', 'stiff', '--write', str(tmp_path / 'own')]) == 0
    assert [path.name for path in (tmp_path / 'own').iterdir()] == ['stiff.yaml']
    assert read_choice(tmp_path / 'own' / 'stiff.yaml')[1] == BUDGETS['stiff']


def test_a_preset_that_is_none_is_told(capsys):
    """A mistyped name would be passed over, or end in a traceback."""
    with pytest.raises(SystemExit):
        main(['study', 'presets', 'scene.yaml', '--only', 'stif'])
    assert "'fast', 'balanced', 'accurate', 'stiff'" in capsys.readouterr().err


@pytest.mark.parametrize('name', PRESETS)
def test_shipped_files_tell_the_budget_they_were_chosen_by(name):
    """A preset would claim an accuracy that it was not chosen for."""
    assert read_choice(shipped(name)[0])[1] == BUDGETS[name]


@pytest.mark.parametrize('name', PRESETS)
def test_shipped_files_tell_the_scene_they_were_chosen_on(name):
    """A preset would claim what was measured on a scene that is not there, or is another one."""
    path, scene_path = shipped(name)
    scene = load_scene(scene_path)
    assert f'# nodes: {scene.rows} x {scene.cols}\n' in path.read_text()


@pytest.mark.long
def test_shipped_presets_keep_to_their_errors(tmp_path, capsys):
    """What a preset says of its error would not be so."""
    for name in PRESETS:
        path, scene = shipped(name)
        assert main([
            'study', 'tradeoff', str(scene), '--out', str(tmp_path / scene.stem),
            '--check', str(path)]) == 0
        print(capsys.readouterr().out)
