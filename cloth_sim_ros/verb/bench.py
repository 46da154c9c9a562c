# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
Benchmark this device.

Rounds of the variants are interleaved, so that their ratios are robust against drift of the clock
rate. Each variant is compared with the last one, by default the paper's layout. LP_NUM_THREADS
sets the number of llvmpipe threads.

--solver measures the implicit step instead: solves per second including set-up, iterations to a
residual of 1e-2, and error against a direct float64 solve.

--modes compares whole modes on a light cloth that falls while two corners are pinned: real-time
factor, stretch, work and energy gain. The modes alternate every 20 ms of simulated time;
docs/notes/performance.md defines the figures.

--contact compares a cloth that is dropped over a sphere with the same cloth without it, and among
20 spheres, and with one that hangs from two corners, in modes mass_spring and constraint: a cloth
that falls freely leaves an implicit mode next to nothing to solve. They alternate every 20 ms of
simulated time.

--layers compares a towel on a floor, flat and folded in half, with self-contact and without it, in
each mode: processor time of a simulated second, a step of each in turn.

--batch compares many small cloths that step together with one simulation after the other.

--environments does so with environments of gymnasium, which has to be installed.

--camera measures the processor time of pictures beside a cloth, by what is taken of them.

--node measures what a node costs beyond its simulation: CPU time per simulated second as topics
and the recording are added one after another, at 50 frames per second, and the clouds that a
reliable subscriber in another process misses. It needs ROS.

--page measures all sections of docs/speed.md, each by the command that it shows, and writes that
page, which keeps its other text. It takes about eleven minutes on two cores; --only measures some
sections and leaves the others as they are.

For example:
  cloth_sim bench
  cloth_sim bench --sizes 512 1024 --rounds 9 --json
  cloth_sim bench --variants block=4 block=2 block=1,loads=storage
  cloth_sim bench --solver
  cloth_sim bench --solver --baseline paper
  cloth_sim bench --modes --grids 32,64
  cloth_sim bench --contact --sizes 64
  cloth_sim bench --layers --sizes 32 64
  cloth_sim bench --batch --sizes 12 32 --cloths 256
  cloth_sim bench --camera
  cloth_sim bench --node --sizes 32 64 --rounds 3
  cloth_sim bench --start-up config/drape.yaml
  cloth_sim bench --page docs/speed.md
  cloth_sim bench --page my_device.md --only springs modes
"""

from argparse import ArgumentParser
from argparse import ArgumentTypeError
from argparse import Namespace
from functools import partial
import json
import math
from pathlib import Path
import statistics

from cloth_sim_ros.files.close_name import refuse_unknown
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.files.generated_page import GeneratedPage
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study import speed_page
from cloth_sim_ros.study.batch_speed import measure_batch
from cloth_sim_ros.study.camera_speed import measure_camera
from cloth_sim_ros.study.mode_comparison import compare_modes
from cloth_sim_ros.study.mode_comparison import comparison_table
from cloth_sim_ros.study.mode_runs import CONTENDERS
from cloth_sim_ros.study.node_cost import measure_node
from cloth_sim_ros.study.self_contact_speed import measure_layers
from cloth_sim_ros.study.self_contact_speed import POSES
from cloth_sim_ros.study.self_contact_speed import STEPS
from cloth_sim_ros.study.solver_speed import compare_solvers
from cloth_sim_ros.study.solver_speed import SolverComparison
from cloth_sim_ros.study.speed import compare_variants
from cloth_sim_ros.study.speed import Comparison
from cloth_sim_ros.study.speed import measure_contact
from cloth_sim_ros.study.timed_solvers import BASELINES
from cloth_sim_ros.verb.scene_arguments import add_tuning_argument
from cloth_sim_ros.verb.scene_arguments import parse_change
from tqdm import tqdm

_START_UP_TIMEOUT = 300.0
_SIZES = [128, 512, 1024]
_SOLVER_SIZES = [52, 128]
# The paper's matrix takes time and memory with the square of the edges.
_PAPER_SOLVER_SIZES = [20]
_GRIDS = [32, 64, 128]
_CONTACT_SIZES = [64]
_LAYERS_SIZES = [32]
_BATCH_SIZES = [32]
_BATCH_FRAMES = 10
_ENVIRONMENT_SIZES = [8, 16, 32]
_CAMERA_SIZES = [64]
_NODE_SIZES = [32, 64, 128]
_CLOTHS = 256
_ENVIRONMENTS = 64
_ROUNDS = 7
# Rounds with --modes, --contact, --layers, --batch and --node, which take minutes each.
_MODES_ROUNDS = 3
_SECONDS = 1.2
_LAYERS_SECONDS = 0.03
_NODE_SECONDS = 6.0


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    parser.add_argument('--sizes', type=int, nargs='+', metavar='N',
                        help='nodes along each side (default: 128 512 1024; with --contact or '
                             '--camera 64, with --layers or --batch 32, with --environments 8 16 '
                             '32, with --node 32 64 128, with --solver 52 128, with --baseline '
                             'paper 20)')
    parser.add_argument('--variants', nargs='+', metavar='name=value,...',
                        default=['layout=fused', 'layout=paper'],
                        help='scene parameters of each variant (default: %(default)s)')
    parser.add_argument('--rounds', type=int, metavar='N',
                        help=f'rounds of each variant (default: {_ROUNDS}, with --modes, '
                             f'--contact, --layers, --batch or --node {_MODES_ROUNDS})')
    parser.add_argument('--round-seconds', type=float, default=0.4, metavar='T',
                        help='wall time of a round [s] (default: %(default)s)')
    parser.add_argument('--solver', action='store_true',
                        help='benchmark the solver of the implicit step instead')
    parser.add_argument('--baseline', choices=('paper', 'block_jacobi'),
                        help='solver to compare it with, in interleaved rounds')
    parser.add_argument('--modes', action='store_true',
                        help='compare whole modes on a falling cloth instead')
    parser.add_argument('--contact', action='store_true',
                        help='compare a cloth with and without colliders instead')
    parser.add_argument('--layers', action='store_true',
                        help='compare a towel with and without self-contact instead')
    parser.add_argument('--settle', type=float, default=0.3, metavar='T',
                        help='simulated time before the first round with --layers [s] (default: '
                             '%(default)s)')
    parser.add_argument('--batch', action='store_true',
                        help='compare a batch of cloths with single runs instead')
    parser.add_argument('--environments', action='store_true',
                        help='compare environments of gymnasium, together and one by one, instead')
    parser.add_argument('--cloths', type=int, metavar='N',
                        help=f'cloths of --batch (default: {_CLOTHS}), or environments of '
                             f'--environments (default: {_ENVIRONMENTS})')
    parser.add_argument('--camera', action='store_true',
                        help='measure pictures of a camera beside a cloth instead')
    parser.add_argument('--grids', type=_parse_grids, default=_GRIDS, metavar='N,N,...',
                        help='nodes along each side with --modes (default: '
                             f'{",".join(map(str, _GRIDS))})')
    parser.add_argument('--node', action='store_true',
                        help='measure the CPU time of a node instead, topic by topic')
    parser.add_argument('--beside', metavar='CHECKOUT',
                        help='with --node, measure the node of another checkout in turn')
    parser.add_argument('--seconds', type=float, metavar='T',
                        help='simulated time of a round with --modes, --contact or --layers, or '
                             f'of a measurement with --node [s] (default: {_SECONDS}, with '
                             f'--layers {_LAYERS_SECONDS}, with --node {_NODE_SECONDS})')
    parser.add_argument('--only', nargs='+', default=[], metavar='NAME',
                        help=f'modes to compare with --modes, of {", ".join(CONTENDERS)}, or '
                             'sections to measure with --page, of '
                             f'{", ".join(each.name for each in speed_page.SECTIONS)} (default: '
                             'all)')
    parser.add_argument('--start-up', metavar='SCENE.yaml',
                        help='measure the time from the start of a node to its first point '
                             'cloud instead; needs ROS')
    parser.add_argument('--set', action='append', default=[], metavar='name=value',
                        dest='changes', help='set a parameter of the node of --start-up or --node')
    parser.add_argument('--page', type=Path, metavar='FILE.md',
                        help='measure all of this, by the commands that the page shows, and write '
                             'the page; one that has figures keeps its other text')
    parser.add_argument('--quick', action='store_true',
                        help='with --page, make one round of small cloths, whose figures mean '
                             'little')
    add_tuning_argument(parser)
    parser.add_argument('--json', action='store_true', help='print JSON, one line per size')


def main(args: Namespace) -> int:
    """Measure and print."""
    if args.page:
        return _write_page(args)
    if args.seconds is None:
        args.seconds = (
            _NODE_SECONDS if args.node else _LAYERS_SECONDS if args.layers else _SECONDS)
    if args.rounds is None:
        args.rounds = _MODES_ROUNDS if (
            args.modes or args.node or args.contact or args.layers or args.batch) else _ROUNDS
    if args.cloths is None:
        args.cloths = _ENVIRONMENTS if args.environments else _CLOTHS
    _check(args)
    for is_asked, measured in (
            (args.modes, _compare_modes), (args.node, _measure_node),
            (args.contact, _compare_contact), (args.layers, _compare_layers),
            (args.batch, _compare_batch), (args.environments, _compare_environments),
            (args.camera, _measure_camera), (args.start_up, _measure_start_up),
            (args.solver, _measure_solver)):
        if is_asked:
            return measured(args)
    return _compare_layouts(args)


def _check(args: Namespace) -> None:
    if args.rounds < 1:
        raise ClothSimError(f'there cannot be {args.rounds} rounds: give 1 or more')
    if not 0.0 < args.seconds < math.inf:
        raise ClothSimError(
            f'a round cannot last {args.seconds:g} s: give a finite time above 0')


def _compare_layouts(args: Namespace) -> int:
    variants = {text: dict(map(parse_change, text.split(','))) for text in args.variants}
    for comparison in compare_variants(
            variants, args.sizes or _SIZES, args.rounds, args.round_seconds):
        print(json.dumps(comparison.as_dict()) if args.json else _in_words(comparison),
              flush=True)
    return 0


def _parse_grids(text: str) -> list[int]:
    try:
        return list(dict.fromkeys(int(part) for part in text.split(',')))
    except ValueError:
        raise ArgumentTypeError(
            f'{shown(text)} is not a list of integers: write it as in 32,64') from None


def _write_page(args: Namespace) -> int:
    sections = speed_page.chosen(args.only)
    page = GeneratedPage(args.page, speed_page.BEGIN, speed_page.END)
    found = list(tqdm(
        speed_page.measure(sections, is_trial=args.quick), total=len(sections),
        unit=' sections', leave=False, disable=None))
    print(speed_page.markdown(found), end='')
    page.write(speed_page.markdown(found, page.written))
    return 0


def _compare_modes(args: Namespace) -> int:
    refuse_unknown('mode', args.only, CONTENDERS)
    comparison = compare_modes(
        [CONTENDERS[name] for name in dict.fromkeys(args.only or CONTENDERS)], args.grids,
        seconds=args.seconds, rounds=args.rounds,
        progress=partial(tqdm, unit=' frames', leave=False, disable=None))
    print(json.dumps(comparison.as_dict(), allow_nan=False) if args.json
          else comparison_table(comparison))
    return 0


def _compare_contact(args: Namespace) -> int:
    for nodes in args.sizes or _CONTACT_SIZES:
        for mode in ('mass_spring', 'constraint'):
            found = measure_contact(
                mode, nodes, seconds=args.seconds, rounds=args.rounds)
            print(json.dumps(found.as_dict()) if args.json else found.in_words(), flush=True)
    return 0


def _compare_layers(args: Namespace) -> int:
    for nodes in args.sizes or _LAYERS_SIZES:
        for pose in POSES:
            for mode in STEPS:
                found = measure_layers(
                    pose, mode, nodes, settle=args.settle, seconds=args.seconds,
                    rounds=args.rounds)
                print(json.dumps(found.as_dict()) if args.json else found.in_words(), flush=True)
    return 0


def _compare_environments(args: Namespace) -> int:
    # gymnasium is needed for this figure alone.
    from cloth_sim_ros.study.environment_speed import measure_environments
    for nodes in args.sizes or _ENVIRONMENT_SIZES:
        found = measure_environments(nodes, args.cloths, args.rounds)
        print(json.dumps(found.as_dict()) if args.json else found.in_words(), flush=True)
    return 0


def _measure_camera(args: Namespace) -> int:
    for nodes in args.sizes or _CAMERA_SIZES:
        for found in measure_camera(nodes, args.rounds):
            print(json.dumps(found.as_dict()) if args.json else found.in_words(), flush=True)
    return 0


def _compare_batch(args: Namespace) -> int:
    for size in args.sizes or _BATCH_SIZES:
        for is_controlled in (False, True):
            found = measure_batch(
                size, args.cloths, is_controlled=is_controlled, frames=_BATCH_FRAMES,
                rounds=args.rounds)
            print(json.dumps(found.as_dict()) if args.json else found.in_words(), flush=True)
    return 0


def _measure_node(args: Namespace) -> int:
    for cost in measure_node(
            args.sizes or _NODE_SIZES, dict(map(parse_change, args.changes)),
            seconds=args.seconds, rounds=args.rounds,
            checkouts=[args.beside, ''] if args.beside else ['']):
        print(json.dumps(cost.as_dict()) if args.json else cost.in_words(), flush=True)
    return 0


def _measure_start_up(args: Namespace) -> int:
    # ROS is needed for this figure alone.
    from cloth_sim_ros.study.start_up import time_to_first_cloud
    times = [
        time_to_first_cloud(
            args.start_up, dict(map(parse_change, args.changes)), _START_UP_TIMEOUT)
        for _ in range(args.rounds)]
    print(json.dumps({'scene': args.start_up, 'seconds_to_first_cloud': times})
          if args.json else f'first cloud after {statistics.median(times):.2f} s '
          f'(median of {len(times)}, {min(times):.2f} to {max(times):.2f})')
    return 0


def _measure_solver(args: Namespace) -> int:
    sizes = args.sizes or (
        _PAPER_SOLVER_SIZES if args.baseline == 'paper' else _SOLVER_SIZES)
    baseline = BASELINES[args.baseline] if args.baseline else None
    for comparison in compare_solvers(
            sizes, args.rounds, args.round_seconds, baseline=baseline):
        print(json.dumps(comparison.as_dict()) if args.json
              else _solver_in_words(comparison), flush=True)
    return 0


def _solver_in_words(comparison: SolverComparison) -> str:
    lines = [f'{comparison.rows} x {comparison.cols} on {comparison.device}']
    for speed in comparison.speeds:
        lines.append(
            f'  {speed.solver:12} {speed.step:17} after {speed.drape_time} s: '
            f'{speed.median:7.1f} solves/s ({min(speed.rounds):.1f} to {max(speed.rounds):.1f}), '
            f'{speed.iterations:3} iterations to {speed.residual:.1e}, '
            f'dv off by {speed.velocity_error:.1e} of its norm'
            + ('' if speed.reached else ', NOT REACHED'))
    if comparison.ratios:
        lines.append(
            f'  {comparison.speeds[0].solver} over {comparison.speeds[1].solver}: '
            f'{statistics.median(comparison.ratios):.1f} x ({min(comparison.ratios):.1f} to '
            f'{max(comparison.ratios):.1f})')
    return '\n'.join(lines)


def _in_words(comparison: Comparison) -> str:
    lines = [f'{comparison.rows} x {comparison.cols} on {comparison.device}']
    for speed in comparison.speeds:
        lines.append(
            f'  {speed.variant:24}{speed.median / 1e6:7.1f} million node steps/s, '
            f'{speed.ratio:5.2f} x ({min(speed.ratio_rounds):.2f} to '
            f'{max(speed.ratio_rounds):.2f}; {speed.loads} loads, block {speed.block})')
    return '\n'.join(lines)
