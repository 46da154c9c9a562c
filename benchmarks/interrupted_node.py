# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Interrupt a recording node at random moments of its life: exit codes, times, whole recordings.

Nodes of all modes and sizes, some of them with steps that take a second, some with a switch under
way, get SIGINT after a random time, from before they have started until they run. A recording is
whole when it ends as MCAP says, and has the statistics of each frame that it has a cloud of.

For example:
  python benchmarks/interrupted_node.py --count 30
"""

from argparse import ArgumentParser
from collections import Counter
from dataclasses import dataclass
import json
from pathlib import Path
import random
import signal
import subprocess
import sys
import tempfile
import time

from mcap.reader import make_reader

_SIZES = (12, 32, 64, 128)
_MODES = ('mass_spring', 'constraint', 'adaptive')
# Latest interrupt after the start of the process [s]: a node without a cache is compiling by then,
# one with a cache runs.
_LATEST = 12.0


@dataclass
class Outcome:
    """
    How a node ended.

    :param after: of its start, when it was interrupted [s]
    :param took: until the process had ended [s]
    :param code: its exit code
    :param frames: recorded; None without a recording
    :param fault: what is wrong; empty if nothing is
    """

    scene: str
    after: float
    took: float
    code: int
    frames: int | None
    fault: str


def frames_of(folder: Path) -> tuple[int | None, str]:
    """Return the frames of the recording in ``folder``, and what is wrong with it."""
    files = sorted(folder.rglob('*.mcap'))
    if not files:
        return None, ''
    counts: Counter[str] = Counter()
    for file in files:
        with file.open('rb') as stream:
            reader = make_reader(stream)
            if reader.get_summary() is None:
                return None, f'{file.name} has no summary'
            for _, channel, _ in reader.iter_messages():
                counts[channel.topic.rpartition('/')[2]] += 1
    if counts['points'] != counts['stats']:
        return counts['points'], f'{counts["points"]} clouds, {counts["stats"]} statistics'
    return counts['points'], ''


def interrupted(choose: random.Random) -> Outcome:
    """Run a node and interrupt it."""
    mode, size, after = choose.choice(_MODES), choose.choice(_SIZES), choose.uniform(0.0, _LATEST)
    with tempfile.TemporaryDirectory() as folder:
        values = {
            'rows': size, 'cols': size, 'mode': mode, 'recording.enabled': True,
            'recording.directory': folder, 'real_time_factor': choose.choice((0.0, 1.0)),
            'dt': choose.choice((0.005, 0.02))}
        node = subprocess.Popen(
            [sys.executable, '-m', 'cloth_sim_ros.node', '--ros-args',
             *(part for name, value in values.items()
               for part in ('-p', f'{name}:={json.dumps(value)}'))],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        time.sleep(after)
        begin = time.monotonic()
        node.send_signal(signal.SIGINT)
        said, _ = node.communicate(timeout=120.0)
        took = time.monotonic() - begin
        frames, fault = frames_of(Path(folder))
    if node.returncode != 0:
        fault = f'exit code {node.returncode}: {said.strip().splitlines()[-1:]}'
    elif 'Traceback' in said:
        fault = 'a traceback'
    return Outcome(f'{mode}, {size} x {size}', after, took, node.returncode, frames, fault)


def main() -> int:
    """Interrupt nodes, and print a line for each; return 1 where something was wrong."""
    parser = ArgumentParser(description=__doc__.partition('\n\n')[0])
    parser.add_argument('--count', type=int, default=30, metavar='N')
    parser.add_argument('--seed', type=int, default=35)
    args = parser.parse_args()
    choose = random.Random(args.seed)
    outcomes = []
    for _ in range(args.count):
        each = interrupted(choose)
        outcomes.append(each)
        print(f'{each.scene:22} after {each.after:5.2f} s: ended in {each.took:.2f} s, code '
              f'{each.code}, {each.frames} frames{", " + each.fault if each.fault else ""}',
              flush=True)
    wrong = sum(bool(each.fault) for each in outcomes)
    print(f'{len(outcomes)} interrupted, {wrong} wrong, slowest end '
          f'{max(each.took for each in outcomes):.2f} s')
    return int(wrong > 0)


if __name__ == '__main__':
    sys.exit(main())
