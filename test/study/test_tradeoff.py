# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The study as its user runs it."""

import json

from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.verb.main import main
from made_study import GRID
from made_study import SOFT
import pytest
import yaml


@pytest.fixture(scope='module')
def folder(tmp_path_factory):
    """Write a scene and a grid."""
    folder = tmp_path_factory.mktemp('tradeoff')
    scene = yaml.safe_dump({'/**': {'ros__parameters': SOFT}})
    (folder / 'scene.yaml').write_text(scene)
    (folder / 'grid.yaml').write_text(yaml.safe_dump(GRID))
    return folder


def study(folder, *arguments):
    """Run the study and return its exit code."""
    return main([
        'study', 'tradeoff', str(folder / 'scene.yaml'), '--grid', str(folder / 'grid.yaml'),
        '--out', str(folder / 'out'), '--jobs', '1', *arguments])


@pytest.mark.long
def test_it_writes_its_results_and_a_choice_that_holds(folder, capsys):
    """A user would have no table, no figure, or a choice that the node does not take."""
    assert study(folder, '--budget-error', '0.05') == 0
    out = folder / 'out'
    lines = [json.loads(line) for line in (out / 'table.jsonl').read_text().splitlines()]
    assert len(lines) == 3 and all(line['device'] for line in lines)
    assert (out / 'tradeoff.png').read_bytes().startswith(b'\x89PNG')
    assert '## What a real-time budget buys' in (out / 'tradeoff.md').read_text()
    chosen = load_parameters(out / 'params.yaml')
    # What differs from the scene: its mode is that already.
    assert set(chosen) <= {'dt', 'refine'} and chosen['dt'] == 0.02
    assert '# error: ' in (out / 'params.yaml').read_text()
    capsys.readouterr()
    assert study(folder, '--check', str(out / 'params.yaml')) == 0
    assert 'holds (budget-error: 0.05)' in capsys.readouterr().out
    assert main(['run', str(folder / 'scene.yaml'), '--params', str(out / 'params.yaml'),
                 '--seconds', '0.02', '--json']) == 0
    assert json.loads(capsys.readouterr().out)['dt'] == 0.02


def test_cheapest_setting_within_a_strain_budget(folder, capsys):
    """A user who bounds the strain would get a setting above the bound, or a slow one."""
    hard = {'model': 'hard', 'over': {'dt': [0.02, 0.01]},
            'set': {'mode': 'constraint', 'auto_substeps': True}}
    (folder / 'modes.yaml').write_text(yaml.safe_dump(
        {**GRID, 'methods': {**GRID['methods'], 'hard': hard}}))
    arguments = ['--grid', str(folder / 'modes.yaml')]
    assert study(folder, *arguments, '--budget-strain', '0.05') == 0
    assert 'the cheapest setting with a largest strain of 0.05 or less: hard, dt 0.0' in (
        capsys.readouterr().out)
    chosen = folder / 'out' / 'params.yaml'
    assert load_parameters(chosen)['mode'] == 'constraint'
    # The springs of this soft cloth stretch by far more than the budget.
    rows = map(json.loads, (folder / 'out' / 'table.jsonl').read_text().splitlines())
    rows = {row['setting']: row for row in rows}
    assert rows['refine 4']['peak_strain'] > 0.05
    timed = [row for row in rows.values() if row['method'] == 'hard' and row['wall_seconds']]
    assert load_parameters(chosen)['dt'] == float(min(
        timed, key=lambda row: row['wall_seconds'])['setting'].split()[1])
    scene = Scene({**SOFT, **load_parameters(chosen)})
    simulation = Simulation(scene)
    strains = []
    for _ in range(10):
        simulation.advance(0.02)
        strains.append(simulation.measure().max_strain)
    simulation.close()
    assert max(strains) <= 0.05
    assert study(folder, *arguments, '--check', str(chosen)) == 0
    assert 'holds (budget-strain: 0.05)' in capsys.readouterr().out


@pytest.mark.long
def test_a_forecast_comes_first_and_quick_is_a_part(folder, tmp_path, capsys):
    """A study of hours would begin without a word, and there was no shorter one."""
    more = {'rows': 8, 'cols': 8, 'variants': [{'stiffness': 2.0}], 'times': [0.02, 0.04, 0.06]}
    (folder / 'more.yaml').write_text(yaml.safe_dump(
        {**GRID, **{name: more[name] for name in ('variants', 'times')}}))
    arguments = ['--grid', str(folder / 'more.yaml')]
    assert study(folder, *arguments, '--out', str(tmp_path / 'all')) == 0
    whole = capsys.readouterr().err.splitlines()[0]
    # Each variant has 3 settings and 3 references.
    assert whole.startswith('cloth_sim study: 12 runs in 1 processes take ')
    assert whole.endswith('--quick measures fewer settings')
    assert study(folder, *arguments, '--quick', '--out', str(tmp_path / 'quick')) == 0
    assert capsys.readouterr().err.startswith('cloth_sim study: 5 runs in 1 processes take ')
    lines = (tmp_path / 'quick' / 'table.jsonl').read_text().splitlines()
    assert [json.loads(line)['setting'] for line in lines] == ['refine 1', 'refine 4']
    # Nothing is left to forecast.
    assert study(folder, *arguments, '--quick', '--out', str(tmp_path / 'quick')) == 0
    assert 'runs in' not in capsys.readouterr().err


@pytest.mark.parametrize('arguments, told', [
    (['--budget-strain', '1e-9'], 'give a larger --budget-strain'),
    (['--budget-strain', '2'], 'would allow 200 %, and must be below 1: give 0.02 for 2 %'),
    (['--budget-strain', '1'], 'give 0.01 for 1 %'),
    (['--budget-error', '5'], 'give 0.05 for 5 %'), (['--budget-strain', 'nan'], 'above 0'),
    (['--budget-error', '-1'], '--budget-error must be above 0'),
    (['--jobs', '0'], '--jobs must be 1 or more'),
    (['--budget-error', '1e-9'], 'give a larger --budget-error'),
    (['--check', 'nothing.yaml'], 'cannot be read'),
])
def test_what_is_wrong_is_told(folder, capsys, arguments, told):
    """A mistake would end in a traceback, or in a choice nobody asked for."""
    assert study(folder, *arguments) == 1
    error = capsys.readouterr().err.splitlines()[-1]
    assert error.startswith('cloth_sim study: ') and told in error
