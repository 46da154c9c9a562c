# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Time the cloths of the paper: Table 10 with the limits of section 5, or Fig. 7, 8 or 9.

A frame is one step, and is not drawn. On each cloth a plain serial C program on one core, the
paper's shaders and those of this project take turns from the same state, so that their ratios are
robust against drift of the clock rate. Without a C compiler the serial program is NumPy, and says
so. What is bound to exceed --row-seconds is not run, and the table says why.

For example:
  cloth_sim paper table10
  cloth_sim paper table10 --json --rounds 9
  cloth_sim paper table10 --methods constraint --sizes 12 16
  cloth_sim paper fig7 --plot fig7.png
"""

from argparse import ArgumentParser
from argparse import Namespace
from collections.abc import Iterator
from collections.abc import Sequence
from dataclasses import asdict
import json
import math
from typing import Any

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.paper.cloths import FIGURE_7
from cloth_sim_ros.study.paper.cloths import FIGURE_8
from cloth_sim_ros.study.paper.cloths import FIGURE_9
from cloth_sim_ros.study.paper.cloths import LIMITS
from cloth_sim_ros.study.paper.cloths import PaperCloth
from cloth_sim_ros.study.paper.cloths import square
from cloth_sim_ros.study.paper.cloths import TABLE_10
from cloth_sim_ros.study.paper.contenders import CONTENDERS
from cloth_sim_ros.study.paper.plot import write_plot
from cloth_sim_ros.study.paper.table import growth_line
from cloth_sim_ros.study.paper.table import heading
from cloth_sim_ros.study.paper.table import real_time_line
from cloth_sim_ros.study.paper.table import table_rows
from cloth_sim_ros.study.paper.timing import growths
from cloth_sim_ros.study.paper.timing import time_alone
from cloth_sim_ros.study.paper.timing import TimedCloth
from tqdm import tqdm

# Table 10 has no adaptive cloth: two small ones, to see the growth up to the limit.
_TABLE = (*TABLE_10, square('adaptive', 32), square('adaptive', 64), *LIMITS)
_TITLES = {
    'fig7': 'Fig. 7: mass-spring', 'fig8': 'Fig. 8: constraint enforcement',
    'fig9': 'Fig. 9: adaptive constraints'}
_CLOTHS = {'table10': _TABLE, 'fig7': FIGURE_7, 'fig8': FIGURE_8, 'fig9': FIGURE_9}
_LEAST_SIDE = 3
_MOST_SIDE = 4096
_MOST_ROUNDS = 1000


def add_arguments(parser: ArgumentParser, figure: str) -> None:
    """Add the arguments of ``figure``."""
    parser.add_argument('--rounds', type=int, default=9, metavar='N',
                        help='rounds of each program (default: %(default)s)')
    parser.add_argument('--turn-seconds', type=float, default=0.15, metavar='T',
                        help='wall time of a turn, one step at least [s] (default: %(default)s)')
    parser.add_argument('--row-seconds', type=float, default=45.0, metavar='T',
                        help='wall time of a cloth, after which no round begins [s] '
                             '(default: %(default)s)')
    parser.add_argument('--sizes', type=int, nargs='+', metavar='N',
                        help="nodes along each side, instead of the paper's cloths")
    parser.add_argument('--json', action='store_true', help='print JSON, one document')
    if figure in _TITLES:
        parser.add_argument('--plot', default=f'{figure}.png', metavar='FILE.png',
                            help='image to write (default: %(default)s)')
    else:
        parser.add_argument('--methods', nargs='+', choices=CONTENDERS, metavar='NAME',
                            help=f'methods to time, of {", ".join(CONTENDERS)} (default: all)')


def main(args: Namespace) -> int:
    """Measure, print, and draw a figure."""
    _check(args)
    cloths = _cloths(args)
    timed = []
    for cloth in tqdm(cloths, unit=' cloths', leave=False, disable=None):
        timed.append(time_alone(
            cloth, rounds=args.rounds, turn_seconds=args.turn_seconds,
            row_seconds=args.row_seconds))
        if not args.json:
            tqdm.write('\n'.join(_lines(timed)))
    if args.json:
        print(json.dumps(_document(timed), allow_nan=False))
    else:
        print('\n'.join(_summary(timed)))
    if args.figure in _TITLES:
        write_plot(args.plot, timed[0].method, _TITLES[args.figure], timed)
        if not args.json:
            print(args.plot)
    return 0


def _check(args: Namespace) -> None:
    if not 1 <= args.rounds <= _MOST_ROUNDS:
        raise ClothSimError(
            f'--rounds must be 1 to {_MOST_ROUNDS}, got {args.rounds}: give a number of them')
    for name, value in (
            ('turn', args.turn_seconds), ('row', args.row_seconds)):
        if not 0.0 < value < math.inf:
            raise ClothSimError(
                f'--{name}-seconds must be finite and above 0, got {value:g}: give a time in '
                'seconds')
    for side in args.sizes or ():
        if not _LEAST_SIDE <= side <= _MOST_SIDE:
            raise ClothSimError(
                f'--sizes has {side}, and a cloth here has {_LEAST_SIDE} to {_MOST_SIDE} nodes '
                'along each side: give another size')


def _cloths(args: Namespace) -> list[PaperCloth]:
    """Return what is timed, method by method."""
    offered = _CLOTHS[args.figure]
    methods = getattr(args, 'methods', None) or {cloth.method for cloth in offered}
    return [
        cloth for method in CONTENDERS if method in methods
        for cloth in (
            [square(method, side) for side in dict.fromkeys(args.sizes)] if args.sizes
            else [cloth for cloth in offered if cloth.method == method])]


def _lines(timed: Sequence[TimedCloth]) -> Iterator[str]:
    """Yield the lines of the last cloth, under a heading where what it says changes."""
    *before, cloth = timed
    if not before or heading(before[-1]) != heading(cloth):
        yield heading(cloth)
    yield table_rows(cloth)


def _by_method(timed: Sequence[TimedCloth]) -> dict[str, list[TimedCloth]]:
    return {
        method: [cloth for cloth in timed if cloth.method == method]
        for method in dict.fromkeys(cloth.method for cloth in timed)}


def _summary(timed: Sequence[TimedCloth]) -> Iterator[str]:
    for method, cloths in _by_method(timed).items():
        found = growths(cloths)
        if found:
            yield f'\n{method}: {growth_line(found)}'
    limits = {(cloth.method, cloth.nodes, cloth.springs) for cloth in LIMITS}
    for number, cloth in enumerate(
            cloth for cloth in timed if (cloth.method, cloth.nodes, cloth.springs) in limits):
        yield ('' if number else '\n') + real_time_line(cloth)


def _document(timed: Sequence[TimedCloth]) -> dict[str, Any]:
    return {
        'cloths': [cloth.as_dict() for cloth in timed],
        'growth': {
            method: {name: asdict(growth) for name, growth in growths(cloths).items()}
            for method, cloths in _by_method(timed).items()}}
