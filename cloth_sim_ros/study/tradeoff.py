# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
Measure the accuracy-cost trade-off of modes and settings on a scene, and choose among them.

The error is the RMS position error over times and nodes against a converged run, relative to the
side of the cloth. Runs are distributed over processes; promising settings and the cheapest one of
each method are timed afterwards, in turn. An interrupted study resumes where it stopped.

Writes to --out: results.jsonl (every run), table.csv, table.jsonl, tradeoff.png, tradeoff.md (a
summary of the results) and, with a budget, a parameter file for the node.

For example:
  cloth_sim study tradeoff config/drape.yaml
  cloth_sim study tradeoff config/drape.yaml --budget-rtf 1
  cloth_sim study tradeoff config/drape.yaml --budget-error 1e-3 --write fast.yaml
  cloth_sim study tradeoff config/drape.yaml --budget-strain 0.02
  cloth_sim study tradeoff config/drape.yaml --budget-strain 0.02 --quick
  cloth_sim study tradeoff config/drape.yaml --check fast.yaml
"""

from argparse import ArgumentParser
from argparse import Namespace
from collections.abc import Callable
from collections.abc import Sequence
from pathlib import Path
import sys

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.trade.choice import Budget
from cloth_sim_ros.study.trade.choice import BUDGETS
from cloth_sim_ros.study.trade.choice import SpeedBudget
from cloth_sim_ros.study.trade.choice import StrainBudget
from cloth_sim_ros.study.trade.choice import write_choice
from cloth_sim_ros.study.trade.front import Row
from cloth_sim_ros.study.trade.front import within_strain
from cloth_sim_ros.study.trade.grid import default_grid_path
from cloth_sim_ros.study.trade.grid import Grid
from cloth_sim_ros.study.trade.grid import load_grid
from cloth_sim_ros.study.trade.grid import quick_grid
from cloth_sim_ros.study.trade.grid import Variant
from cloth_sim_ros.study.trade.measured import check
from cloth_sim_ros.study.trade.measured import measure
from cloth_sim_ros.study.trade.measured import Measured
from cloth_sim_ros.study.trade.page import write_table
from cloth_sim_ros.study.workers import add_run_arguments
from cloth_sim_ros.study.workers import workers_of

TAKES_SCENE = True


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this study."""
    parser.add_argument('--grid', metavar='GRID.yaml',
                        help='settings to measure (default: config/studies/tradeoff.yaml)')
    parser.add_argument('--quick', action='store_true',
                        help='measure the scene alone, with the coarsest and the finest setting '
                             'of each method, up to the second time of the grid')
    add_run_arguments(parser, 'studies/tradeoff')
    parser.add_argument('--figure', metavar='FIGURE.png',
                        help='figure to write (default: tradeoff.png in --out)')
    budget = parser.add_mutually_exclusive_group()
    budget.add_argument('--budget-error', type=float, metavar='E',
                        help='choose the fastest setting with at most this error')
    budget.add_argument('--budget-rtf', type=float, metavar='R',
                        help='choose the most accurate setting with at least this real-time '
                             'factor')
    budget.add_argument('--budget-strain', type=float, metavar='S',
                        help='choose the cheapest setting, of any mode, that keeps the strain of '
                             'every structural and shear edge within this limit, 0.02 for 2 %%')
    budget.add_argument('--check', metavar='PARAMS.yaml',
                        help='measure a choice again, and report whether it meets its budget')
    parser.add_argument('--write', metavar='PARAMS.yaml',
                        help='file for the choice (default: params.yaml in --out)')


def main(args: Namespace) -> int:
    """Make the runs and print the results."""
    budget = _budget(args)
    grid = load_grid(args.grid or default_grid_path())
    if args.quick:
        grid = quick_grid(grid)
    with ResultsFolder(args.out) as results:
        if args.check:
            return check(Path(args.check), args.scene, grid, results, workers_of(args))
        _tell_forecast(args, grid, results)
        measured = measure(
            args.scene, grid, results, workers_of(args), _wanted(budget))
        _write(Path(args.out), measured, args)
    if budget is not None:
        path = Path(args.write or Path(args.out) / 'params.yaml')
        row = budget.choose(measured.rows_of(Variant()))
        write_choice(path, row, budget, args.scene_file, args.scene)
        print(
            f'{budget.in_words()}: {row.setting.method}, {row.setting.label}: largest strain '
            f'{row.peak_strain:.3g}, real-time factor {1.0 / row.cost:.3g}; written to {path}')
    return 0


def _write(folder: Path, measured: Measured, args: Namespace) -> None:
    # Slow to import, and of use at the end alone.
    from cloth_sim_ros.study.trade.page import page
    from cloth_sim_ros.study.trade.plot import write_plot
    text = page(measured, args.scene_file)
    try:
        write_table(folder, measured.rows)
        write_plot(Path(args.figure or folder / 'tradeoff.png'), measured)
        (folder / 'tradeoff.md').write_text(text, encoding='utf-8')
    except OSError as error:
        raise ClothSimError(f'the results cannot be written: {error}') from error
    print(text)
    print(f'all of it is in {folder}')


def _tell_forecast(args: Namespace, grid: Grid, results: ResultsFolder) -> None:
    # Slow to import, and of no use to --help.
    from cloth_sim_ros.study.trade.forecast import forecast
    workers = workers_of(args)
    found = forecast(args.scene, grid, results, workers.processes)
    if found.runs:
        words = found.in_words(
            workers.processes, '' if args.quick else '--quick measures fewer settings')
        print(f'cloth_sim study: {words}', file=sys.stderr, flush=True)


def _budget(args: Namespace) -> Budget | None:
    for budget in BUDGETS:
        value = getattr(args, budget.option.replace('-', '_'))
        if value is not None and not value > 0.0:
            raise ClothSimError(f'--{budget.option} must be above 0, got {value:g}')
        if value is not None and budget is not SpeedBudget and not value < 1.0:
            percent = value / 100.0
            hint = f'give {percent:g} for {value:g} %' if percent < 1.0 else 'give 0.02 for 2 %'
            raise ClothSimError(
                f'--{budget.option} {value:g} would allow {100.0 * value:g} %, and must be below '
                f'1: {hint}')
        if value is not None:
            return budget(value)
    return None


def _wanted(budget: Budget | None) -> Callable[[Sequence[Row]], Sequence[Row]]:
    # A cheap setting within a strain may be far from the exact ones, which are timed anyway.
    if isinstance(budget, StrainBudget):
        return lambda rows: within_strain(rows, budget.limit)
    return lambda rows: ()
