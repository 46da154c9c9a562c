# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A chosen setting as a parameter file, measured again to see that it keeps to its budget."""

from dataclasses import replace
from pathlib import Path
import tempfile
from typing import Any

from cloth_sim_ros.files.checked_yaml import MOST_BYTES
from cloth_sim_ros.files.regular_file import read_regular
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_file import load_parameters
from cloth_sim_ros.study.runs.make_runs import make_runs
from cloth_sim_ros.study.runs.results_folder import ResultsFolder
from cloth_sim_ros.study.runs.run import Run
from cloth_sim_ros.study.runs.workers import Workers
from cloth_sim_ros.study.trade.budget import Budget
from cloth_sim_ros.study.trade.budget import BUDGETS
from cloth_sim_ros.study.trade.compared import compare
from cloth_sim_ros.study.trade.compared import own_model
from cloth_sim_ros.study.trade.grid import Grid
from cloth_sim_ros.study.trade.grid import Setting
from cloth_sim_ros.study.trade.plan import Plan
from cloth_sim_ros.study.trade.row import Row
from cloth_sim_ros.study.trade.variant import Variant
import yaml

_OWN_ERROR, _OWN_SPEED, _OWN_STRAIN = 'error', 'real-time factor', 'largest strain'


def write_choice(
        path: Path, row: Row, budget: Budget, scene_name: str, scene: Scene, *,
        only_changes: bool = True) -> None:
    """
    Write the parameters of ``row``, and where they come from.

    :param only_changes: leave out those that ``scene`` has already
    :raises ClothSimError: when the file can't be written
    """
    values = row.setting.values
    if only_changes:
        changed = Scene({**scene.values, **values})
        values = {name: value for name, value in values.items() if changed[name] != scene[name]}
    head = [
        f'For {scene_name}: {budget.in_words()}.',
        'Written by `cloth_sim study`; give it after the file of the scene.',
        f'device: {row.run.device}',
        f'version: {row.run.version}',
        f'scene sha256: {Run("", dict(scene.values)).scene_sha256}',
        f'nodes: {scene.rows} x {scene.cols}',
        f'{budget.option}: {budget.limit:g}',
        *([f'{_OWN_ERROR}: {row.scene.position:.2e} of the side'] if row.scene else []),
        f'{_OWN_SPEED}: {1.0 / row.cost:.2f}',
        f'{_OWN_STRAIN}: {row.peak_strain:.3f}']
    body = yaml.safe_dump({'/**': {'ros__parameters': values}}, sort_keys=False)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(''.join(f'# {line}\n' for line in head) + body, encoding='utf-8')
    except OSError as error:
        raise ClothSimError(f'{path} cannot be written: {error}') from error


def read_choice(path: Path) -> tuple[dict[str, Any], Budget, str]:
    """Return parameters and budget of a file that ``write_choice`` made, and what it tells."""
    values = load_parameters(path)
    told = dict(
        line.removeprefix('# ').split(': ', 1)
        for line in read_regular(path, MOST_BYTES).decode().splitlines()
        if line.startswith('# ') and ': ' in line)
    summary = ', '.join(
        f'{name} {told[name]}' for name in (_OWN_ERROR, _OWN_SPEED, _OWN_STRAIN) if name in told)
    for budget in BUDGETS:
        if budget.option in told:
            try:
                return values, budget(float(told[budget.option])), summary
            except ValueError:
                break  # a word where a number should be tells no more than nothing
    raise ClothSimError(
        f'{path} does not state its budget: give a file that '
        f'{" or ".join(f"--{budget.option}" for budget in BUDGETS)} wrote')


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
        f'{path} states: {told}\nmeasured again: error {row.scene.position:.2e} of the side, '
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
