# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
Measure the cost of each feature of a scene by leaving it out, and the error without it.

Variants are timed in one process in interleaved rounds, so that their ratios are robust against
drift of the clock rate; a ratio below 1 means that leaving the feature out saves time. The list of
compiled passes shows that unused features cost nothing. Messages and recordings need the ROS
packages.

For example:
  cloth_sim study cost config/drape.yaml
  cloth_sim study cost config/curtain.yaml --rounds 15 --set mode=adaptive
  cloth_sim study cost config/drape.yaml --passes
  cloth_sim study cost config/drape.yaml --without-messages
"""

from argparse import ArgumentParser
from argparse import Namespace
from pathlib import Path
from typing import Any

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.feature.costs import ALL_OUTPUTS
from cloth_sim_ros.study.feature.costs import WHOLE
from cloth_sim_ros.study.feature.features import has_feature
from cloth_sim_ros.study.feature.features import OUTPUTS
from cloth_sim_ros.study.feature.features import SCENE_FEATURES
from cloth_sim_ros.study.feature.pass_list import pass_list
from cloth_sim_ros.study.feature.pass_list import pass_table
from cloth_sim_ros.study.feature.report import cost_table
from cloth_sim_ros.study.feature.report import passes_report
from cloth_sim_ros.study.make_runs import make_runs
from cloth_sim_ros.study.results import Result
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.results import Run
from cloth_sim_ros.study.scene_values import given_values
from cloth_sim_ros.study.workers import add_run_arguments
from cloth_sim_ros.study.workers import workers_of

TAKES_SCENE = True
_RUNS = 'cloth_sim_ros.study.feature.costs'


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this study."""
    parser.add_argument('--rounds', type=int, default=9, metavar='N',
                        help='rounds of each variant (default: %(default)s)')
    parser.add_argument('--seconds', type=float, default=0.5, metavar='T',
                        help='simulated time of a round, and before results are compared [s] '
                             '(default: %(default)s)')
    parser.add_argument('--rate', type=float, default=50.0, metavar='HZ',
                        help='frames per second of simulated time (default: %(default)s)')
    parser.add_argument('--without-messages', action='store_true',
                        help='time only the simulation')
    parser.add_argument('--passes', action='store_true',
                        help='only list the shader passes that the scene compiles')
    add_run_arguments(parser, 'studies/cost')


def main(args: Namespace) -> int:
    """Make the runs, and write the tables."""
    values = given_values(args.scene)
    if args.passes:
        print(pass_table(pass_list(values)))
        return 0
    for name, value in (('rounds', args.rounds), ('seconds', args.seconds), ('rate', args.rate)):
        if not value > 0:
            raise ClothSimError(f'--{name} must be above 0, got {value}')
    present = [feature for feature in SCENE_FEATURES if has_feature(values, feature)]
    absent = [feature for feature in SCENE_FEATURES if feature not in present]
    outputs = [] if args.without_messages else list(OUTPUTS)
    timing = Run(f'{_RUNS}:time_variants', values, {
        'features': [*present, *outputs, *([ALL_OUTPUTS] if outputs else [])],
        'outputs': outputs, 'rounds': args.rounds, 'round_seconds': args.seconds,
        'frame_seconds': 1.0 / args.rate})
    folder = Path(args.out)
    with ResultsFolder(folder) as results:
        workers = workers_of(args)
        losses = make_runs(
            [_run('compare_results', values, feature, args.seconds) for feature in present],
            results, workers, title='losses')
        passes = make_runs(
            [_run('list_passes', values, feature, args.seconds) for feature in (WHOLE, *present)],
            results, workers, title='passes')
        timed, = make_runs([timing], results, workers, title='timing', alone=True)
    whole, *others = (_values(result) for result in passes)
    text = '\n'.join((
        cost_table(_values(timed), dict(zip(present, map(_values, losses))), absent,
                   args.seconds, timed.device),
        passes_report(whole, dict(zip(present, others)), absent)))
    (folder / 'cost.md').write_text(text, encoding='utf-8')
    print(text)
    print(f'the tables are in {folder / "cost.md"}')
    return 0


def _run(function: str, values: dict[str, Any], feature: str, seconds: float) -> Run:
    return Run(f'{_RUNS}:{function}', values, {'feature': feature, 'seconds': seconds})


def _values(result: Result) -> dict[str, Any]:
    if not result.is_done:
        raise ClothSimError(f'a run of the study has not ended: {result.reason}')
    return dict(result.values)
