# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A study finds what is known of a scene."""

from dataclasses import replace
import json

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.results import DONE
from cloth_sim_ros.study.results import LINES
from cloth_sim_ros.study.results import Result
from cloth_sim_ros.study.trade.choice import ErrorBudget
from cloth_sim_ros.study.trade.choice import SpeedBudget
from cloth_sim_ros.study.trade.front import cheapest_of_each
from cloth_sim_ros.study.trade.front import near_front
from cloth_sim_ros.study.trade.grid import Variant
from cloth_sim_ros.study.trade.measured import costs_of
from cloth_sim_ros.study.trade.page import page
from cloth_sim_ros.study.trade.page import write_table
from made_study import GRID
from made_study import small_study
import numpy as np
import pytest

LIMITED = {
    'model': 'limited', 'set': {'mode': 'adaptive', 'adaptive.threshold': 0.5, 'dt': 0.02},
    'over': {'refine': [1, 4]}}
UNSTABLE = {
    'model': 'springs', 'set': {'mode': 'mass_spring', 'auto_substeps': False},
    'over': {'dt': [0.02]}}


@pytest.fixture(scope='module')
def study(tmp_path_factory):
    """Make one study with a coarse variant, a limit nothing reaches, and a refused setting."""
    folder = tmp_path_factory.mktemp('study')
    spring = {'model': 'springs', 'set': {'mode': 'mass_spring', 'dt': 0.02},
              'over': {'refine': [1, 2, 4]}}
    return small_study(
        folder, variants=[{'resolution': 0.5}],
        methods={'mass_spring': spring, 'adaptive': LIMITED, 'unstable': UNSTABLE}), folder


def rows_of(measured, method, variant=None):
    """Return the rows of a method, in the order of the grid."""
    return [row for row in measured.rows_of(variant or Variant()) if row.setting.method == method]


def test_the_order_of_mass_spring_is_one(study):
    """Errors of a study would not be those of the time step."""
    rows = rows_of(study[0], 'mass_spring')
    substeps = np.array([row.run.values['substeps'] for row in rows])
    for name in ('own', 'scene'):
        errors = np.array([getattr(row, name).position for row in rows])
        slopes = -np.diff(np.log(errors)) / np.diff(np.log(substeps))
        print(f'measured {slopes.round(3)} of 0.95 to 1.1 allowed: order of the {name} error')
        assert np.all((slopes > 0.95) & (slopes < 1.1))


def test_a_limit_that_nothing_reaches_changes_nothing(study):
    """Two methods that make the same steps would have different errors."""
    spring, limited = (rows_of(study[0], name)[0] for name in ('mass_spring', 'adaptive'))
    assert limited.scene == spring.scene
    # The finest of its own model is what the others are measured against.
    assert rows_of(study[0], 'adaptive')[1].own is None


def test_a_coarse_cloth_has_the_error_of_its_model(study):
    """Finer steps of a coarse cloth would seem to bring it to the scene."""
    coarse = rows_of(study[0], 'mass_spring', Variant(resolution=0.5))
    assert coarse[-1].own.position < 0.3 * coarse[0].own.position
    assert coarse[-1].scene.position > 3.0 * coarse[-1].own.position
    assert coarse[-1].scene.position > 0.6 * coarse[0].scene.position


def test_what_was_refused_is_told(study, tmp_path):
    """A setting that cannot be run would vanish from the table, or end the study."""
    measured = study[0]
    write_table(tmp_path, measured.rows)
    lines = [json.loads(line) for line in (tmp_path / 'table.jsonl').read_text().splitlines()]
    refused = [line for line in lines if line['method'] == 'unstable']
    assert [line['outcome'] for line in refused] == ['refused'] * 2
    assert all('stability limit' in line['reason'] for line in refused)
    assert len((tmp_path / 'table.csv').read_text().splitlines()) == 1 + len(lines)
    assert '| the scene | unstable | refused | 1 |' in page(measured, 'soft.yaml')


def test_what_may_matter_is_timed(study):
    """A choice would be made by the time of runs that shared the processor."""
    rows = study[0].rows_of(Variant())
    # Which of these steps is faster is close: a small cloth takes as long for one as for four.
    untimed = [replace(row, rounds=(), wall_share=1.0) for row in rows]
    near = near_front(untimed, study[0].grid.margin, of_scene=True)
    assert near and all(rows[untimed.index(row)].rounds for row in near)
    # A mode that is slow on this scene would have no cost in the table.
    cheapest = cheapest_of_each(untimed)
    assert {row.setting.method for row in cheapest} == {'mass_spring', 'adaptive'}
    assert all(rows[untimed.index(row)].rounds for row in cheapest)
    assert all(row.wall_seconds > 0.0 for row in rows if row.rounds)


def timed_run(device):
    """Return a result of two settings that other load held up in one of two rounds."""
    values = {
        'wall_seconds': [[2.0, 5.0], [4.2, 4.0]], 'processor_seconds': [[2.0, 2.1], [4.0, 4.0]]}
    return Result('', '', DONE, '', {}, '', {}, values, device, '', 0.0)


def test_other_load_shows_in_no_cost_on_software():
    """A setting would win because the machine was busy while another one had its turn."""
    assert costs_of(timed_run('llvmpipe (LLVM 15.0.6, 256 bits)')) == [(2.0, 2.1), (4.0, 4.0)]
    # What a GPU does is in the wall time alone.
    assert costs_of(timed_run('a GPU')) == [(2.0, 5.0), (4.2, 4.0)]


def test_a_cost_is_told_over_that_of_the_same_round(study):
    """Rounds that were slow for all would make one setting look slower."""
    row = study[0].rows[0]
    slow, fast = (replace(row, rounds=rounds) for rounds in ((2.0, 6.0, 4.4), (1.0, 3.0, 2.0)))
    assert slow.cost_over(fast) == (2.0, 2.0, 2.2)
    assert slow.cost_over(replace(fast, rounds=())) is None
    first = '| the scene | mass_spring, refine 1 | springs |'
    line = next(
        line for line in page(study[0], 'soft.yaml').splitlines() if line.startswith(first))
    assert '| 1.00 (1.00-1.00) |' in line


def test_buckling_scene_is_compared_while_valid(study):
    """Stiff light cloth would have no study, or errors below those of its reference."""
    reference = {**GRID['reference'], 'converged': 1e-12, 'loosely_converged': 1e-3}
    measured = small_study(study[1], reference=reference)
    assert measured.allowed[Variant()] == 1e-3 and measured.times[Variant()] == 2
    changes = measured.references[measured.truth].changes
    text = page(measured, 'soft.yaml')
    assert '| 0.001 | 0.1, 0.2 |' in text
    assert ('not resolved' in text) == (changes.max() > 1e-4)


def test_a_budget_chooses_by_error(study):
    """The setting that is written would not keep to what was asked."""
    errors = sorted(row.scene.position for row in rows_of(study[0], 'mass_spring'))
    rows = study[0].rows_of(Variant())
    chosen = ErrorBudget(1.01 * errors[0]).choose(rows)
    assert chosen.scene.position == errors[0]
    with pytest.raises(ClothSimError, match='give a larger --budget-error'):
        ErrorBudget(0.5 * errors[0]).choose(rows)
    with pytest.raises(ClothSimError, match='give a smaller --budget-rtf'):
        SpeedBudget(1e9).choose(rows)


def test_nothing_is_made_twice(study):
    """A finished study would be made again to look at it."""
    measured, folder = study
    lines = (folder / LINES).read_text()
    again = small_study(folder)
    assert (folder / LINES).read_text().startswith(lines)
    assert again.rows[0].scene == measured.rows[0].scene


def test_a_grid_without_a_setting_that_runs_is_told(study):
    """A study of nothing but refused settings would end in a traceback."""
    with pytest.raises(ClothSimError, match='could be compared on the scene: .*stability limit'):
        small_study(study[1], methods={'unstable': UNSTABLE})


def test_a_scene_without_a_reference_is_told(study):
    """Errors against a motion that has not converged would be taken for errors of settings."""
    with pytest.raises(ClothSimError, match='has not converged to 1e-12'):
        small_study(study[1], reference={
            'refine': [4, 8, 16], 'converged': 1e-12, 'loosely_converged': 1e-12,
            'float64_node_steps': 1e7})
