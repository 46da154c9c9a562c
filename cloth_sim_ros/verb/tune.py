# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Measure which loads and block are fastest on this device, and have runs use them.

Takes seconds, and as long again when the shaders are compiled for the first time. In mode
mass_spring, scenes that set neither `loads` nor `block` use what was found from then on. It is
kept in the cache directory of the user, for this device and this version of its driver.

The built-in choice is replaced only by one that is at least 3 % faster in every round. Runs with
--no-tune, or with CLOTH_SIM_TUNING=off in the environment, use the built-in choices, as does a
device for which this was never done.

For example:
  cloth_sim tune
  cloth_sim tune --sizes 32 2048 --rounds 9
  cloth_sim tune --json
"""

from argparse import ArgumentParser
from argparse import Namespace
from contextlib import closing
import json

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.device.tuning import is_off
from cloth_sim_ros.sim.device.tuning import MOST_SIZES
from cloth_sim_ros.sim.device.tuning import OFF
from cloth_sim_ros.sim.device.tuning import Tuning
from cloth_sim_ros.sim.device.tuning import VARIABLE
from cloth_sim_ros.sim.device.tuning import write_tuning
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.layout_tuning import ROUNDS
from cloth_sim_ros.study.layout_tuning import SIZES
from cloth_sim_ros.study.layout_tuning import tune

_SMALLEST, _LARGEST = 2, 8192
_MOST_ROUNDS = 1000


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    parser.add_argument('--sizes', type=int, nargs='+', metavar='N', default=list(SIZES),
                        help='nodes along each side of the cloths to measure; one in between '
                             'uses a choice that both neighbours have (default: '
                             f'{" ".join(map(str, SIZES))})')
    parser.add_argument('--rounds', type=int, default=ROUNDS, metavar='N',
                        help='rounds of each choice with each cloth (default: %(default)s)')
    parser.add_argument('--json', action='store_true', help='print JSON, one line per size')


def main(args: Namespace) -> int:
    """Measure, print and keep."""
    _check(args)
    # Without worker threads, as small cloths have it: with them the order is the same.
    with closing(Context(single_thread=True)) as context:
        device, driver = context.device, context.version
        if not args.json:
            print(f'{device}, OpenGL {driver}', flush=True)
        choices = {}
        for found in tune(context, sorted(set(args.sizes)), args.rounds):
            choices[found.side] = found.choice
            print(json.dumps({'device': device, **found.as_dict()}) if args.json
                  else found.in_words(), flush=True)
    path = write_tuning(Tuning(device, driver, choices))
    if not args.json:
        print(f'kept in {path}; remove it to return to the built-in choices'
              + (f'; {VARIABLE}={OFF} is set, so nothing uses it' if is_off() else ''))
    return 0


def _check(args: Namespace) -> None:
    for side in args.sizes:
        if not _SMALLEST <= side <= _LARGEST:
            raise ClothSimError(
                f'--sizes must be from {_SMALLEST} to {_LARGEST}, got {side}: give the nodes '
                'along a side')
    if len(args.sizes) > MOST_SIZES:
        raise ClothSimError(
            f'--sizes takes up to {MOST_SIZES} sizes, got {len(args.sizes)}: give fewer')
    if not 1 <= args.rounds <= _MOST_ROUNDS:
        raise ClothSimError(
            f'--rounds must be from 1 to {_MOST_ROUNDS}, got {args.rounds}: {ROUNDS} are usual')
