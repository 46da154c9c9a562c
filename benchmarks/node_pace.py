# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Measure how fast a node runs as a whole, with all its topics read and recorded.

The node runs as fast as possible (real_time_factor 0). Another process reads its topics. The
figures are simulated seconds a second of wall time, one a measurement; checkouts take turns.

For example:
  git worktree add --detach /tmp/former abfb2b5 && /tmp/former/scripts/setup.sh
  python benchmarks/node_pace.py --sizes 32 64 128 --beside /tmp/former
"""

from argparse import ArgumentParser
import json
import subprocess
import tempfile
import time

from cloth_sim_ros.study.node_cost import environment
from cloth_sim_ros.study.node_cost import interpreter
from cloth_sim_ros.study.node_cost import scene_values

_TOPICS = ('points', 'markers', 'stats', 'pins/wrenches')
# Wall time until the node has compiled and its reader is discovered [s].
_START = 6.0


def pace(checkout: str, size: int, seconds: float) -> float:
    """Return the real-time factor of a node of ``checkout`` over the last ``seconds`` [s]."""
    with tempfile.TemporaryDirectory() as folder:
        values = {
            **scene_values(size, {}), 'real_time_factor': 0.0, 'publish.rate': 50.0,
            'recording.enabled': True, 'recording.directory': folder}
        node = subprocess.Popen(
            [interpreter(checkout), '-m', 'cloth_sim_ros.node', '--ros-args',
             *(part for name, value in values.items()
               for part in ('-p', f'{name}:={json.dumps(value)}'))],
            cwd=checkout or None, env=environment(checkout), stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        reader = subprocess.Popen(
            [interpreter(checkout), '-m', 'cloth_sim_ros.study.topic_listener', '/cloth_sim',
             *_TOPICS],
            cwd=checkout or None, env=environment(checkout), stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, text=True)
        try:
            time.sleep(_START + seconds)
            found = json.loads(reader.communicate()[0].splitlines()[-1])
        finally:
            node.terminate()
            node.wait()
            reader.kill()
            reader.wait()
    frames = found['arrivals']['stats']
    frames = [frame for frame in frames if frame[0] > frames[-1][0] - seconds]
    (begin, first), (end, last) = frames[0][:2], frames[-1][:2]
    return (last - first) / (end - begin)


def main() -> None:
    """Measure and print."""
    parser = ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--sizes', type=int, nargs='+', default=[32, 64, 128], metavar='N')
    parser.add_argument('--beside', default='', metavar='CHECKOUT', help='of other code')
    parser.add_argument('--rounds', type=int, default=2)
    parser.add_argument('--seconds', type=float, default=4.0)
    args = parser.parse_args()
    checkouts = [args.beside, ''] if args.beside else ['']
    for size in args.sizes:
        found: dict[str, list[float]] = {checkout: [] for checkout in checkouts}
        for _ in range(args.rounds):
            for checkout in checkouts:
                found[checkout].append(pace(checkout, size, args.seconds))
        for checkout, values in found.items():
            print(f'{size} x {size}, {checkout or "this code"}: '
                  + ', '.join(f'{value:.2f}' for value in values))


if __name__ == '__main__':
    main()
