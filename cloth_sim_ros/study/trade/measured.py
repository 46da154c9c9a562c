# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Make the runs of a study of the trade."""

from collections.abc import Callable
from collections.abc import Sequence
from dataclasses import replace
import statistics

from cloth_sim_ros.gl.context import is_software
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.make_runs import make_runs
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.results import Run
from cloth_sim_ros.study.trade.compared import compare
from cloth_sim_ros.study.trade.compared import Measured
from cloth_sim_ros.study.trade.front import near_front
from cloth_sim_ros.study.trade.grid import Grid
from cloth_sim_ros.study.trade.plan import Plan
from cloth_sim_ros.study.trade.row import Row
from cloth_sim_ros.study.trade.variant import Variant
from cloth_sim_ros.study.workers import Workers


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
    """Return the rows with the wall time of those that may matter."""
    chosen = {}
    for variant in measured.grid.variants:
        rows = measured.rows_of(variant)
        # What runs on a GPU is not seen in the processor's time.
        known = all(is_software(row.run.device) for row in rows if row.run.is_done)
        of_scene = variant.is_scene
        chosen[variant] = [row for row in rows if row.is_useful(of_scene)]
        if known:
            chosen[variant] = near_front(rows, measured.grid.margin, of_scene=of_scene)
        if of_scene:
            known_rows = {_name(row) for row in chosen[variant]}
            chosen[variant] += [row for row in wanted(rows) if _name(row) not in known_rows]
    runs: dict[Variant, Run] = {
        variant: plan.cost(variant, [row.setting for row in rows])
        for variant, rows in chosen.items() if rows}
    made = make_runs(list(runs.values()), results, Workers(), title='cost', alone=True)
    rounds: dict[tuple[Variant, str, str], tuple[float, ...]] = {}
    shares: dict[Variant, float] = {}
    for variant, result in zip(runs, made):
        if result.is_done:
            own = [tuple(wall) for wall in result.values['wall_seconds']]
            rounds.update(zip(map(_name, chosen[variant]), own))
            shares[variant] = statistics.median(
                statistics.median(wall) / row.run.values['processor_seconds']
                for wall, row in zip(own, chosen[variant]))
    return [
        replace(row, rounds=rounds.get(_name(row), ()), wall_share=shares.get(row.variant, 1.0))
        for row in measured.rows]


def _name(row: Row) -> tuple[Variant, str, str]:
    return row.variant, row.setting.method, row.setting.label
