# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Make the runs of a study of the trade, compare them, and measure a choice again."""

from collections.abc import Callable
from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import dataclass
from dataclasses import replace
from pathlib import Path
import statistics
import tempfile

from cloth_sim_ros.gl.context import is_software
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.make_runs import make_runs
from cloth_sim_ros.study.results import Result
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.results import Run
from cloth_sim_ros.study.trade.accuracy import errors
from cloth_sim_ros.study.trade.accuracy import extrapolated
from cloth_sim_ros.study.trade.accuracy import finest
from cloth_sim_ros.study.trade.accuracy import path_of
from cloth_sim_ros.study.trade.accuracy import Reference
from cloth_sim_ros.study.trade.choice import read_choice
from cloth_sim_ros.study.trade.front import cheapest_of_each
from cloth_sim_ros.study.trade.front import near_front
from cloth_sim_ros.study.trade.front import Row
from cloth_sim_ros.study.trade.grid import Grid
from cloth_sim_ros.study.trade.grid import Plan
from cloth_sim_ros.study.trade.grid import Setting
from cloth_sim_ros.study.trade.grid import Variant
from cloth_sim_ros.study.workers import Workers
import numpy as np

Key = tuple[Variant, str]
Ran = tuple[Variant, Setting, Result]


@dataclass(frozen=True)
class Measured:
    """
    All that came out.

    :param references: by variant and model
    :param times: how many of the grid's times count, by variant
    :param allowed: what the reference may change by at these, over the side, by variant
    """

    scene: Scene
    grid: Grid
    references: dict[Key, Reference]
    times: dict[Variant, int]
    allowed: dict[Variant, float]
    rows: list[Row]

    def rows_of(self, variant: Variant) -> list[Row]:
        """Return the rows of one variant."""
        return [row for row in self.rows if row.variant == variant]

    @property
    def truth(self) -> Key:
        """Tell which reference is that of the scene as it was given."""
        return Variant(), own_model(self.scene)


def own_model(scene: Scene) -> str:
    """Return what the mode of ``scene`` models."""
    return AVAILABLE[scene['mode']].edge_model(scene)


def compare(
        scene: Scene, grid: Grid, ran: Sequence[Ran],
        rungs: Mapping[Variant, Sequence[Result]]) -> Measured:
    """
    Return the errors of all runs.

    :param ran: variant, setting and result of each
    :param rungs: runs of the springs of each variant, coarse to fine
    :raises ClothSimError: when there is no reference for the scene itself
    """
    side = max(scene['width'], scene['height'])
    references, times, tolerances = {}, {}, {}
    for variant, results in rungs.items():
        if all(result.is_done for result in results):
            references[variant, 'springs'] = extrapolated(results, grid.reference_refine)
        by_model: dict[str, list[Result]] = {}
        for of, setting, result in ran:
            if of == variant and setting.model != 'springs' and result.is_done:
                by_model.setdefault(setting.model, []).append(result)
        references.update({
            (variant, model): finest(results) for model, results in by_model.items()})
        springs = references.get((variant, 'springs'))
        tolerances[variant], times[variant] = _converged(springs, variant, grid, side)
    truth = references.get((Variant(), own_model(scene)))
    if truth is None or not times[Variant()]:
        failed = next((result for result in rungs[Variant()] if not result.is_done), None)
        raise ClothSimError(
            'there is no reference for the scene: ' + (
                failed.reason if failed else
                f'it has not converged to {grid.loosely_converged:g} of the side at '
                f'{grid.times[0]:g} s: give earlier times, or more in reference.refine')
            + ' (--grid)')
    rows = []
    for variant, setting, result in ran:
        reference = references.get((variant, setting.model))
        own = of_scene = None
        if result.is_done:
            path = path_of(result)
            # The finest run of a model is its reference, and has no error to tell.
            if reference is not None and times[variant] and reference.run != result.key:
                own = errors(path, reference.path, scene, *_counting(grid, times[variant]))
            if truth.run != result.key:
                of_scene = errors(
                    path.on_nodes_of(scene.rows, scene.cols), truth.path, scene,
                    *_counting(grid, times[Variant()]))
        rows.append(Row(variant, setting, result, own, of_scene))
    if not any(row.scene for row in rows if row.variant.is_scene):
        reason = next((row.run.reason for row in rows if row.run.reason), 'there are none')
        raise ClothSimError(f'no setting of the grid could be compared on the scene: {reason}')
    return Measured(scene, grid, references, times, tolerances, rows)


def _converged(
        reference: Reference | None, variant: Variant, grid: Grid, side: float
) -> tuple[float, int]:
    """Return what the reference may change by, over the side, and how many times then count."""
    if reference is None:
        return grid.converged, 0
    exactly = reference.converged_times(side * grid.converged)
    if variant.is_scene and exactly:
        return grid.converged, exactly
    return grid.loosely_converged, reference.converged_times(side * grid.loosely_converged)


def _counting(grid: Grid, times: int) -> tuple[int, int]:
    return times, round(grid.times[times - 1] / grid.frame)


# Make the runs of a study of the trade.


def measure(
        scene: Scene, grid: Grid, results: ResultsFolder, workers: Workers,
        wanted: Callable[[Sequence[Row]], Sequence[Row]] = lambda rows: ()) -> Measured:
    """
    Make what is not there yet, and return everything.

    :param wanted: which rows of the scene itself to time as well
    :raises ClothSimError: when there is no reference for the scene itself
    """
    plan = Plan(scene, grid)
    tasks = [(variant, setting) for variant in grid.variants for setting in grid.settings]
    rungs = {variant: plan.references(variant) for variant in grid.variants}
    # The longest first, so that no process ends up alone with one.
    runs = [run for variant in grid.variants for run in reversed(rungs[variant])]
    runs += [plan.trajectory(*task) for task in tasks]
    made = {
        result.key: result
        for result in make_runs(runs, results, workers, title='accuracy')}
    ran = [(*task, made[plan.trajectory(*task).key]) for task in tasks]
    measured = compare(scene, grid, ran, {
        variant: [made[run.key] for run in runs] for variant, runs in rungs.items()})
    return replace(measured, rows=_timed(plan, measured, results, wanted))


def _timed(
        plan: Plan, measured: Measured, results: ResultsFolder,
        wanted: Callable[[Sequence[Row]], Sequence[Row]]) -> list[Row]:
    """Return the rows with the time of those that may matter."""
    chosen = {}
    for variant in measured.grid.variants:
        rows = measured.rows_of(variant)
        of_scene = variant.is_scene
        if all(is_software(row.run.device) for row in rows if row.run.is_done):
            near = near_front(rows, measured.grid.margin, of_scene=of_scene)
        else:
            # Processor time does not include work on a GPU.
            near = [row for row in rows if row.is_useful(of_scene)]
        names = {_name(row) for row in (
            *near, *cheapest_of_each(rows), *(wanted(rows) if of_scene else ()))}
        chosen[variant] = [
            row for row in rows
            if _name(row) in names or row.setting == plan.grid.settings[0] and row.run.is_done]
    runs: dict[Variant, Run] = {
        variant: plan.cost(variant, [row.setting for row in rows])
        for variant, rows in chosen.items() if rows}
    made = make_runs(list(runs.values()), results, Workers(), title='cost', alone=True)
    rounds: dict[tuple[Variant, str, str], tuple[float, ...]] = {}
    shares: dict[Variant, float] = {}
    for variant, result in zip(runs, made):
        if result.is_done:
            own = costs_of(result)
            rounds.update(zip(map(_name, chosen[variant]), own))
            shares[variant] = statistics.median(
                statistics.median(cost) / row.run.values['processor_seconds']
                for cost, row in zip(own, chosen[variant]))
    return [
        replace(row, rounds=rounds.get(_name(row), ()), wall_share=shares.get(row.variant, 1.0))
        for row in measured.rows]


def costs_of(result: Result) -> list[tuple[float, ...]]:
    """
    Return what each setting of a timed run costs in each round, in a simulated second [s].

    On a GPU it is the wall time. On software it is the processor time, in which other load of the
    machine shows least, times the least ratio of both clocks: the wall time with nothing beside.
    """
    wall, processor = (
        np.array(result.values[f'{clock}_seconds']) for clock in ('wall', 'processor'))
    costs = processor * (wall / processor).min() if is_software(result.device) else wall
    return [tuple(own) for own in costs.tolist()]


def _name(row: Row) -> tuple[Variant, str, str]:
    return row.variant, row.setting.method, row.setting.label


# Measure a choice again, and report whether it stays within its budget.


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
    return replace(row, rounds=costs_of(clock)[0])
