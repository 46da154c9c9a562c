# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
Run extreme scenes in every mode: each must stay finite, be refused, or stop with a reason.

A row is nonsense if values become non-finite unreported, energy appears without a source, hard
edges have wrong lengths, a free cloth does not fall freely, or a message suggests no remedy. The
exit code is 1 if a row is nonsense or has an unexpected outcome, apart from known limits.

For example:
  cloth_sim study extremes
  cloth_sim study extremes --long --jobs 2 --out studies/extremes
"""

from argparse import ArgumentParser
from argparse import Namespace
from pathlib import Path

from cloth_sim_ros.study.extremity.report import extreme_table
from cloth_sim_ros.study.extremity.report import is_right
from cloth_sim_ros.study.extremity.scenes import EXTREMES
from cloth_sim_ros.study.make_runs import make_runs
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.results import Run
from cloth_sim_ros.study.workers import add_run_arguments
from cloth_sim_ros.study.workers import workers_of

_FUNCTION = 'cloth_sim_ros.study.extremity.run:run_by_name'


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this study."""
    parser.add_argument('--long', action='store_true',
                        help='also run those that take minutes: a grid of stiffness, mass and dt, '
                             'random scenes, and a million nodes')
    add_run_arguments(parser, 'studies/extremes')


def main(args: Namespace) -> int:
    """Make the runs and write the table."""
    runs = extreme_runs(with_long=args.long)
    folder = Path(args.out)
    with ResultsFolder(folder) as results:
        found = make_runs(runs, results, workers_of(args), title='extremes')
    text = extreme_table(found)
    (folder / 'extremes.md').write_text(text, encoding='utf-8')
    print(text)
    print(f'the table is in {folder / "extremes.md"}')
    return 0 if all(map(is_right, found)) else 1


def extreme_runs(*, with_long: bool) -> list[Run]:
    """Return a run for each extreme and each of its modes."""
    return [
        Run(_FUNCTION, {'mode': mode}, {'name': name})
        for name, extreme in EXTREMES.items() if with_long or not extreme.is_long
        for mode in extreme.modes]
