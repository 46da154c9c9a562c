# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Run a scene of an earlier commit with the code of that commit and with this one, frame by frame.

Both run in processes of their own, on one thread each, and take turns of a frame, so that other
load meets both alike. Compilation and set-up are not timed. The stretch of both is taken from the
positions, by the same formula.

For example:
  git worktree add --detach /tmp/former c0fae0c
  python benchmarks/against_commit.py /tmp/former config/drape.yaml --set mode=constraint
"""

from argparse import ArgumentParser
from argparse import Namespace
from collections.abc import Mapping
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from dataclasses import field
import json
import os
from pathlib import Path
import subprocess
import sys
import time
from typing import Any

from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.verb.scene_arguments import parse_change
import numpy as np

FRAME = 0.02  # [s]
_HERE = Path(__file__).resolve().parents[1]
# Needs no more than both commits have: Scene, and four methods of Simulation.
_WORKER = """
import json, sys, time
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
scene = Scene(json.loads(sys.stdin.readline()))
cloth = Simulation(scene)
def turn(seconds):
    wall, processor = time.perf_counter(), time.process_time()
    cloth.advance(seconds)
    cloth.finish()
    return time.perf_counter() - wall, time.process_time() - processor
turn(0.02)
cloth.reset()
cloth.finish()
print('READY', flush=True)
for line in sys.stdin:
    wall, processor = turn(float(line))
    snapshot = cloth.snapshot()
    found = [wall, processor, snapshot.substeps, snapshot.positions.tolist()]
    print(json.dumps(found), flush=True)
"""


@dataclass
class Contestant:
    """
    A process that advances a scene on request.

    :param name: of the code, and of what is changed of its scene
    :param root: of the checkout whose code it runs
    :param values: parameters of the scene
    """

    name: str
    root: Path
    values: Mapping[str, Any]
    wall: float = 0.0
    processor: float = 0.0
    substeps: list[int] = field(default_factory=list)
    stretches: list[float] = field(default_factory=list)

    def begin(self, processes: ExitStack) -> None:
        """Start the process, compile, and return to the start of the scene."""
        environment = {**os.environ, 'PYTHONPATH': str(self.root), 'LP_NUM_THREADS': '0'}
        self._process = processes.enter_context(subprocess.Popen(
            [sys.executable, '-c', _WORKER], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            text=True, cwd=self.root, env=environment))
        assert self._process.stdin and self._process.stdout  # both are pipes
        self._orders, self._answers = self._process.stdin, self._process.stdout
        # A process that waits for a turn ends when there is none to come.
        processes.callback(self._orders.close)
        self._tell(json.dumps(dict(self.values)))
        while self._answers.readline().strip() != 'READY':
            if self._process.poll() is not None:
                raise SystemExit(f'{self.name} ended before its first step')

    def advance(self, seconds: float) -> None:
        """Advance by ``seconds``, and take times and stretch."""
        self._tell(str(seconds))
        wall, processor, substeps, positions = json.loads(self._answers.readline())
        self.wall += wall
        self.processor += processor
        self.substeps.append(substeps)
        self.stretches.append(largest_stretch(np.array(positions), self.values))

    def _tell(self, line: str) -> None:
        self._orders.write(line + '\n')
        self._orders.flush()


def largest_stretch(positions: np.ndarray, values: Mapping[str, Any]) -> float:
    """
    Return the largest l / L0 - 1 of the structural and shear edges of an even grid.

    :param positions: (rows, cols, 3) [m]
    """
    rows, cols = positions.shape[:2]
    across, down = values['width'] / (cols - 1), values['height'] / (rows - 1)
    diagonal = float(np.hypot(across, down))
    return max(
        float(np.linalg.norm(ends - starts, axis=-1).max()) / rest - 1.0
        for starts, ends, rest in (
            (positions[:, :-1], positions[:, 1:], across),
            (positions[:-1], positions[1:], down),
            (positions[:-1, :-1], positions[1:, 1:], diagonal),
            (positions[:-1, 1:], positions[1:, :-1], diagonal)))


def scene_values(path: Path, changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a file says of its scene, changed, with the size of the cloth in any case."""
    of_node = {field.name for field in NODE_FIELDS}
    values = {name: value for name, value in load_parameters(path).items() if name not in of_node}
    values.update(changes)
    scene = Scene(values)
    return {**values, 'width': scene['width'], 'height': scene['height']}


def read_arguments(arguments: Sequence[str] | None = None) -> Namespace:
    """Return what is measured."""
    parser = ArgumentParser(description=__doc__.strip().splitlines()[0])
    parser.add_argument('former', type=Path, help='work tree of the earlier commit')
    parser.add_argument('scene', help='scene file, below the earlier work tree')
    parser.add_argument('--set', action='append', default=[], metavar='NAME=VALUE',
                        help='changes the scene of both')
    parser.add_argument('--now', action='append', default=[], nargs='+', metavar='NAME=VALUE',
                        help='changes the scene of this commit alone; each --now is one more '
                             'contestant')
    parser.add_argument('--seconds', type=float, default=1.2, help='simulated time [s]')
    return parser.parse_args(arguments)


def main() -> int:
    """Let both take turns, and print what they cost."""
    args = read_arguments()
    values = scene_values(args.former / args.scene, dict(map(parse_change, args.set)))
    former = Contestant('former', args.former.resolve(), values)
    contestants = [former, Contestant('now', _HERE, values), *(
        Contestant(f'now, {" ".join(changes)}', _HERE, {
            **values, **dict(map(parse_change, changes))}) for changes in args.now)]
    frames = round(args.seconds / FRAME)
    begin = time.perf_counter()
    with ExitStack() as processes:
        for contestant in contestants:
            contestant.begin(processes)
        for number in range(frames):
            for contestant in contestants[number % 2:] + contestants[:number % 2]:
                contestant.advance(FRAME)
    seconds = frames * FRAME
    print(f'{args.scene}, {seconds:g} s, frames of {FRAME:g} s in turn, one thread each; '
          f'{time.perf_counter() - begin:.0f} s in all')
    print('| | real-time factor | by processor time | over the former | by processor time '
          '| peak stretch | mean substeps a dt |\n|---|---|---|---|---|---|---|')
    for run in contestants:
        print(
            f'| {run.name} | {seconds / run.wall:.3g} | {seconds / run.processor:.3g} '
            f'| {former.wall / run.wall:.3g} | {former.processor / run.processor:.3g} '
            f'| {100.0 * max(run.stretches):.2g} % | {np.mean(run.substeps):.3g} |')
    return 0


if __name__ == '__main__':
    sys.exit(main())
