# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
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
from collections import Counter
from collections.abc import Mapping
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.feature_costs import ALL_OUTPUTS
from cloth_sim_ros.study.feature_costs import has_feature
from cloth_sim_ros.study.feature_costs import modelled
from cloth_sim_ros.study.feature_costs import OUTPUTS
from cloth_sim_ros.study.feature_costs import pass_list
from cloth_sim_ros.study.feature_costs import pass_table
from cloth_sim_ros.study.feature_costs import SCENE_FEATURES
from cloth_sim_ros.study.feature_costs import WHOLE
from cloth_sim_ros.study.make_runs import make_runs
from cloth_sim_ros.study.results import Result
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.results import Run
from cloth_sim_ros.study.scene_values import given_values
from cloth_sim_ros.study.workers import add_run_arguments
from cloth_sim_ros.study.workers import workers_of


def cost_table(
        timing: Mapping[str, Any], losses: Mapping[str, Mapping[str, Any]],
        absent: Sequence[str], seconds: float, device: str) -> str:
    """
    Return a row for each feature: time without it over that with everything, and what is lost.

    :param losses: of the features of the scene, by name
    :param absent: features the scene has not
    :param seconds: simulated until results are compared [s]
    """
    lines = [
        '| left out | wall time over that with everything, median (rounds) | processor time '
        '| substeps a dt '
        f'| RMS distance of nodes after {seconds:g} s, over the side | largest strain: change |',
        '|---|---|---|---|---|---|']
    for name, variant in timing['variants'].items():
        if name == WHOLE:
            continue
        ratios = variant['ratios']
        loss = losses.get(name)
        lost = 'none, the same bits |' if loss is None or loss['same_bits'] else (
            f'{loss["rms_position"]:.2g} | {loss["strain_difference"]:+.2g} '
            f'of {loss["whole_strain"]:.2g}')
        lines.append(
            f'| {name} | {variant["ratio"]:.2f} ({min(ratios):.2f} to {max(ratios):.2f}) '
            f'| {variant["processor_ratio"]:.2f} | {variant["substeps"]} | {lost} |')
    for name in absent:
        lines.append(f'| {name} | not in this scene | | | none, the same bits | |')
    whole = timing['variants'][WHOLE]
    lines += ['', f'With everything a round takes {whole["seconds"]:.3g} s of wall time, in '
              f'{whole["substeps"]} substeps a dt, on {device}.']
    return '\n'.join(lines) + '\n'


def passes_report(
        whole: Mapping[str, Any], others: Mapping[str, Mapping[str, Any]],
        absent: Sequence[str]) -> str:
    """Return the passes of the scene, and what is different without each feature."""
    lines = ['## Passes of the scene', '', pass_table(whole)]
    lines += ['## What is gone without a feature', '',
              '| left out | passes compiled otherwise, or gone | passes | runs a step of dt '
              '| buffers | bytes |', '|---|---|---|---|---|---|',
              _row('nothing', '', whole)]
    for name in SCENE_FEATURES:
        if name in others:
            lines.append(_row(name, _differences(whole, others[name]), others[name]))
        elif name in absent:
            lines.append(f'| {name} | not in this scene: nothing of it is compiled | | | | |')
    return '\n'.join(lines) + '\n'


def compiled(listed: Mapping[str, Any]) -> Counter[tuple[str, str]]:
    """Return the passes of a list by shader and by what of the model is compiled in."""
    return Counter((each['shader'], modelled(each['defines'])) for each in listed['passes'])


def _differences(whole: Mapping[str, Any], other: Mapping[str, Any]) -> str:
    """Return what ``other`` compiles otherwise, shaders with the same difference together."""
    gone, come = compiled(whole) - compiled(other), compiled(other) - compiled(whole)
    changes: dict[str, list[str]] = {}
    for shader, what in gone:
        others = [set(choices.split(', ')) for name, choices in come if name == shader]
        choices = set(what.split(', '))
        # A shader can have several variants; the one with most defines in common is compared.
        nearest = max(others, key=lambda each: len(each & choices), default=None)
        words = 'gone' if nearest is None else ', '.join(
            [f'without {name}' for name in sorted(choices - nearest)]
            + [f'with {name}' for name in sorted(nearest - choices)])
        changes.setdefault(words, []).append(shader)
    return '; '.join(f'{words}: {", ".join(shaders)}' for words, shaders in changes.items()) or (
        'none')


def _row(name: str, words: str, listed: Mapping[str, Any]) -> str:
    runs = sum(each['runs_per_step'] for each in listed['passes'])
    return (f'| {name} | {words} | {len(listed["passes"])} | {runs:.4g} | {listed["buffers"]} '
            f'| {listed["buffer_bytes"]} |')


TAKES_SCENE = True
_RUNS = 'cloth_sim_ros.study.feature_costs'


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
