# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Measure a choice again, and tell whether it keeps to its budget."""

from dataclasses import replace
from pathlib import Path
import tempfile

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.make_runs import make_runs
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.trade.choice import read_choice
from cloth_sim_ros.study.trade.compared import compare
from cloth_sim_ros.study.trade.compared import own_model
from cloth_sim_ros.study.trade.grid import Grid
from cloth_sim_ros.study.trade.grid import Setting
from cloth_sim_ros.study.trade.plan import Plan
from cloth_sim_ros.study.trade.row import Row
from cloth_sim_ros.study.trade.variant import Variant
from cloth_sim_ros.study.workers import Workers


def check(
        path: Path, scene: Scene, grid: Grid, results: ResultsFolder, workers: Workers) -> int:
    """
    Print error, real-time factor and strain of a choice, measured now, and return the exit code.

    :param path: file that a budget of this study wrote
    :param results: where the reference of the scene may be already
    :raises ClothSimError: when the choice can't be run
    """
    values, budget, told = read_choice(path)
    row = measure_again(values, scene, grid, results, workers)
    holds = budget.holds(row)
    print(
        f'{path} states: {told}\n'
        f'measured again: error {row.scene_errors.position:.2e} of the side, '
        f'real-time factor {1.0 / row.cost:.2f}, largest strain {row.peak_strain:.3f}: '
        f'{"holds" if holds else "does not hold"} ({budget.option}: {budget.limit:g})')
    return 0 if holds else 1


def measure_again(
        values: dict[str, object], scene: Scene, grid: Grid, results: ResultsFolder,
        workers: Workers) -> Row:
    """Return the row of these parameters, its runs made anew, one at a time."""
    choice = Setting('choice', 'springs', values, {})
    model = own_model(scene)
    others = [setting for setting in grid.settings if setting.model == model != 'springs']
    here = Variant()
    plan = Plan(scene, replace(grid, variants=(here,), settings=(choice, *others)))
    rungs = make_runs(plan.references(here), results, workers, title='reference')
    finest = make_runs(
        [plan.trajectory(here, setting) for setting in others], results, workers,
        title='reference')
    with tempfile.TemporaryDirectory() as folder, ResultsFolder(folder) as fresh:
        run, clock = make_runs(
            [plan.trajectory(here, choice), plan.cost(here, [choice])], fresh, workers,
            title='again', alone=True)
    for result in (run, clock):
        if not result.is_done:
            raise ClothSimError(f'the choice cannot be measured: {result.reason}')
    ran = [(here, choice, run), *((here, *pair) for pair in zip(others, finest))]
    row = compare(scene, plan.grid, ran, {here: rungs}).rows[0]
    return replace(row, rounds=tuple(clock.values['wall_seconds'][0]))
