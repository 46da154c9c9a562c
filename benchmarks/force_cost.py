# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Measure what forces on pins cost in a step of dt, against an earlier commit that records none.

Each contestant is a process of its own, on one thread, and they take turns, so that other load
meets all alike. Of several turns the one with the least processor time counts.

For example:
  git worktree add --detach /tmp/former 23c65fc
  python benchmarks/force_cost.py /tmp/former
"""

from argparse import ArgumentParser
from contextlib import ExitStack
import json
import os
from pathlib import Path
import subprocess
import sys

_HERE = Path(__file__).resolve().parents[1]
_CLOTHS = (
    ('mass_spring', 16), ('mass_spring', 32), ('mass_spring', 64), ('constraint', 16),
    ('constraint', 32), ('adaptive', 32))
_STEPS = 16  # of a frame, with dt = 1 ms about what a node makes
# Name, whether the code is that of the earlier commit, steps in a call, what Simulation is given,
# and whether forces are read after each frame, of a window where there are some.
_CONTESTANTS = (
    ('former, in frames', True, _STEPS, {}, False),
    ('in frames', False, _STEPS, {}, False),
    ('former, in frames, read', True, _STEPS, {}, True),
    ('in frames, read', False, _STEPS, {}, True),
    ('former, one by one', True, 1, {}, False),
    ('former, one by one, read', True, 1, {}, True),
    ('one by one, records_forces=False', False, 1, {'records_forces': False}, False),
    ('one by one', False, 1, {}, False),
    ('one by one, read', False, 1, {}, True),
)
_WORKER = """
import json, sys, time
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
values, count, given, reads = json.loads(sys.stdin.readline())
cloth = Simulation(Scene(values), **given)
cloth.warm_up()
has_windows = hasattr(cloth, 'open_force_window')
window = cloth.open_force_window() if reads and has_windows else None
def turn(frames):
    begin = time.process_time()
    for _ in range(frames):
        for _ in range(16 // count):
            cloth.step(count)
        if reads:
            cloth.frame_forces(window) if has_windows else cloth.pin_forces()
    cloth.finish()
    return (time.process_time() - begin) / (16 * frames)
turn(4)
print('READY', flush=True)
for line in sys.stdin:
    print(turn(int(line)), flush=True)
"""


def begin(processes: ExitStack, root: Path, *task: object) -> subprocess.Popen:
    """Start a process with the code in ``root``, and wait until it is ready."""
    process = processes.enter_context(subprocess.Popen(
        [sys.executable, '-c', _WORKER], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        text=True, cwd=root,
        env={**os.environ, 'PYTHONPATH': str(root), 'LP_NUM_THREADS': '0'}))
    # A process that waits for a turn ends when there is none to come.
    processes.callback(process.stdin.close)
    process.stdin.write(json.dumps(task) + '\n')
    process.stdin.flush()
    while (answer := process.stdout.readline().strip()) != 'READY':
        if not answer and process.poll() is not None:
            raise SystemExit('a contestant ended before its first step')
    return process


def advance(process: subprocess.Popen, frames: int) -> float:
    """Return the processor time of a step [s], over ``frames`` of 16 steps."""
    process.stdin.write(f'{frames}\n')
    process.stdin.flush()
    return float(process.stdout.readline())


def measure(former: Path, mode: str, size: int, turns: int) -> dict[str, float]:
    """Return the least processor time of a step [s] of each contestant, by its name."""
    values = {'rows': size, 'cols': size, 'mode': mode, 'pins': ['top_edge'], 'dt': 0.001}
    with ExitStack() as processes:
        running = {
            name: begin(processes, former if is_former else _HERE, values, count, given, reads)
            for name, is_former, count, given, reads in _CONTESTANTS}
        frames = max(1, round(0.3 / (16 * advance(running['one by one'], 2))))
        times = [
            {name: advance(process, frames) for name, process in running.items()}
            for _ in range(turns)]
    return {name: min(turn[name] for turn in times) for name in running}


def main() -> int:
    """Print a table, with what each costs over the earlier commit that steps the same way."""
    parser = ArgumentParser(description=__doc__.strip().splitlines()[0])
    parser.add_argument('former', type=Path, help='work tree of the earlier commit')
    parser.add_argument('--turns', type=int, default=5)
    args = parser.parse_args()
    names = [name for name, is_former, *_ in _CONTESTANTS if not is_former]
    print('| cloth | former: in frames / read / one by one / read | ' + ' | '.join(names) + ' |')
    print('|' + '---|' * (2 + len(names)))
    for mode, size in _CLOTHS:
        found = measure(args.former.resolve(), mode, size, args.turns)
        former = {
            name: found[f'former, {name}' if f'former, {name}' in found else 'former, one by one']
            for name in names}
        shares = [found[name] / former[name] - 1.0 for name in names]
        base = ' / '.join(f'{1e6 * found[name]:.0f}' for name in found if 'former' in name)
        print(
            f'| {mode} {size} x {size} | {base} us | '
            + ' | '.join(f'{100.0 * share:+.0f} %' for share in shares) + ' |', flush=True)
    return 0


if __name__ == '__main__':
    sys.exit(main())
