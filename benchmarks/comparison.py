# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Scenes that users of other simulators reported as wrong, here and there.

Slip in a grip (newton issue 3943, mujoco issue 3328), the force at the grip, and contacts beyond
the capacity of a buffer (newton issues 3795 and 4249) as a loss of momentum. Each scene is run
twice, whose positions have the same bits or not.

The others are no part of the project: python -m pip install mujoco newton

For example:
  LP_NUM_THREADS=0 python benchmarks/comparison.py
  LP_NUM_THREADS=0 python benchmarks/comparison.py --only grip --simulators constraint MuJoCo
"""

from argparse import ArgumentParser
from collections.abc import Callable
from collections.abc import Iterator
from pathlib import Path
import time

import numpy as np
from peers.gripped import GRAVITY
from peers.gripped import Grip
from peers.gripped import HELD_ROWS
from peers.gripped import Pinched
from peers.gripped import Thrown
from peers.gripped import THROWN_MASS
from peers.gripped import THROWN_SPEED
from peers.gripped_here import PinchedHere
from peers.gripped_here import ThrownHere
from peers.gripped_mujoco import Capsule
from peers.gripped_mujoco import PinchedMuJoCo
from peers.gripped_mujoco import ThrownMuJoCo
from peers.gripped_newton import PinchedNewton
from peers.gripped_newton import ThrownNewton

MODES = ('mass_spring', 'constraint', 'adaptive')
# A light sheet in a firm grip, and one as heavy as the capsule of issue 3328, pressed with 12 N.
LIGHT = {friction: Grip(0.0043, friction, 0.1) for friction in (0.5, 1.0, 64.0)}
HEAVY = Grip(0.045, 0.7, 12.0 / (HELD_ROWS * 13))
# Slip is measured from the first time to the second [s].
BEGIN, END = 0.5, 1.5
# Forces are the mean of so many in between: a sheet that swings weighs what it should in the mean.
LOOKS = 100
HIT = 0.2
_BEGIN = '<!-- {} table: written by benchmarks/comparison.py -->'
_END = '<!-- end of the {} table -->'


def pinched() -> Iterator[tuple[str, str, Grip, Callable[[], Pinched]]]:
    """Return scene, simulator, grip and a function to each sheet between pads."""
    for scene, grip in (*((f'mu {mu:g}', grip) for mu, grip in LIGHT.items()), ('45 g', HEAVY)):
        for mode in MODES:
            yield scene, mode, grip, lambda grip=grip, mode=mode: PinchedHere(grip, mode)
        for name, impratio, noslip in (
                ('MuJoCo', 1, 0), ('MuJoCo, impratio 10', 10, 0),
                ('MuJoCo, noslip 10', 1, 10)):
            yield (scene, name, grip, lambda grip=grip, impratio=impratio, noslip=noslip:
                   PinchedMuJoCo(grip, impratio, noslip))
        yield scene, 'Newton, 10 iterations', grip, lambda grip=grip: PinchedNewton(grip, 10)
    for name, cone, impratio, noslip in (
            ('MuJoCo, pyramidal', 'pyramidal', 1, 0), ('MuJoCo', 'elliptic', 1, 0),
            ('MuJoCo, impratio 10', 'elliptic', 10, 0),
            ('MuJoCo, noslip 10', 'elliptic', 10, 10)):
        yield ('capsule of 45 g', name, HEAVY, lambda cone=cone, impratio=impratio,
               noslip=noslip: Capsule(cone, impratio, noslip))


def thrown() -> Iterator[tuple[str, int, Callable[[], Thrown]]]:
    """Return simulator, nodes a side and a function to each sheet that hits a box."""
    for nodes in (12, 40):
        for mode in MODES:
            yield mode, nodes, lambda nodes=nodes, mode=mode: ThrownHere(nodes, mode)
        yield 'MuJoCo', nodes, lambda nodes=nodes: ThrownMuJoCo(nodes)
        for iterations, capacity in ((10, 256), (40, 256), (40, 8192)):
            yield (f'Newton, {iterations} iterations, buffer of {capacity}', nodes,
                   lambda nodes=nodes, iterations=iterations, capacity=capacity:
                   ThrownNewton(nodes, iterations, capacity))


def grip_row(scene: str, name: str, grip: Grip, make: Callable[[], Pinched]) -> str:
    """Measure the slip, the force and the time of a sheet between pads."""
    ends, lifts, slip, taken = [], [], 0.0, 0.0
    for _ in range(2):
        sheet = make()
        sheet.advance(BEGIN)
        before = sheet.positions()[:HELD_ROWS, :, 2].astype(float).mean()
        begin = time.process_time()
        lifts = []
        for end in np.linspace(BEGIN, END, LOOKS + 1)[1:]:
            sheet.advance(end)
            lifts.append(sheet.lift())
        taken = (time.process_time() - begin) / (END - BEGIN)
        ends.append(sheet.positions())
        slip = 1e6 * (before - ends[-1][:HELD_ROWS, :, 2].astype(float).mean()) / (END - BEGIN)
    force = '' if None in lifts else (
        f'{100.0 * (np.mean(lifts) / (grip.mass * GRAVITY) - 1.0):+.2g} %')
    return (f'| {scene} | {name} | {slip:.3g} | {force} | {same(*ends)} | {taken:.2g} |')


def box_row(name: str, nodes: int, make: Callable[[], Thrown]) -> str:
    """Measure the momentum that is lost or made as a sheet hits a box."""
    start = -THROWN_MASS * THROWN_SPEED
    ends, off, deepest, taken = [], 0.0, 0.0, 0.0
    for _ in range(2):
        sheet = make()
        begin = time.process_time()
        sheet.advance(HIT)
        taken = (time.process_time() - begin) / HIT
        ends.append(sheet.positions())
        own, given = sheet.momenta()
        off, deepest = (own + given) / start - 1.0, given / start
    return (f'| {nodes} x {nodes} | {name} | {off:+.2g} | {deepest:.3g} | {same(*ends)} | '
            f'{taken:.2g} |')


def same(first: np.ndarray, second: np.ndarray) -> str:
    """Return whether two runs have the same bits."""
    return 'yes' if np.array_equal(first, second) else 'no'


def write(page: Path, name: str, table: str) -> None:
    """Put a table between its two lines of a page."""
    text = page.read_text(encoding='utf-8')
    begin, end = _BEGIN.format(name), _END.format(name)
    before, found, rest = text.partition(begin)
    if not found or end not in rest:
        raise SystemExit(f'{page} lacks the lines {begin} and {end}: write them')
    page.write_text(f'{before}{begin}\n\n{table}\n{end}{rest.partition(end)[2]}', encoding='utf-8')


def main() -> None:
    """Print both tables."""
    parser = ArgumentParser(description=__doc__.partition('\n\n')[0])
    parser.add_argument('--only', nargs='+', choices=('grip', 'box'), default=('grip', 'box'))
    parser.add_argument('--simulators', nargs='+', default=[''], help='parts of names')
    parser.add_argument('--out', type=Path, help='page that has the tables')
    given = parser.parse_args()
    tables = {
        'grip': ('| scene | simulator | slip [um/s] | force on the pads, off by | same bits '
                 'twice | time per simulated second [s] |', [
                     (name, lambda each=(scene, name, grip, make): grip_row(*each))
                     for scene, name, grip, make in pinched()]),
        'box': ('| nodes | simulator | momentum, off by | of it in the box | same bits twice | '
                'time per simulated second [s] |', [
                    (name, lambda each=(name, nodes, make): box_row(*each))
                    for name, nodes, make in thrown()])}
    for table in given.only:
        header, rows = tables[table]
        lines = [header, '|' + '---|' * 6]
        print('\n'.join(lines))
        for name, row in rows:
            if any(part in name for part in given.simulators):
                try:
                    lines.append(row())
                except ImportError as missing:
                    lines.append(f'| | {name} | left out: {missing} | | | |')
                print(lines[-1], flush=True)
        print()
        if given.out:
            write(given.out, table, '\n'.join(lines) + '\n')


if __name__ == '__main__':
    main()
