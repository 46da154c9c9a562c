# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Steps of environments per second of processor time: many together, and one by one, in turns.

    LP_NUM_THREADS=0 python benchmarks/environments.py
"""

from argparse import ArgumentParser
from collections.abc import Sequence
import statistics
from time import process_time

from cloth_sim_ros.gym import CarryCloth
from cloth_sim_ros.gym import make_vec
from gymnasium.vector import SyncVectorEnv
import numpy as np


def measure(nodes: int, count: int, rounds: int) -> tuple[float, float]:
    """Return the steps of environments per second: of ``make_vec``, and of SyncVectorEnv."""
    scene = {
        'rows': nodes, 'cols': nodes, 'width': 0.4, 'height': 0.4, 'start.pose': 'hanging'}
    made = (make_vec(count, scene, max_steps=None),
            SyncVectorEnv([lambda: CarryCloth(scene)] * count))
    times: tuple[list[float], list[float]] = ([], [])
    random = np.random.default_rng(1)
    for environments in made:
        environments.reset(seed=1)
    # A first round compiles.
    for number in range(rounds + 1):
        actions = random.uniform(-1.0, 1.0, made[0].action_space.shape).astype(np.float32)
        for environments, taken in zip(made, times):
            begin = process_time()
            environments.step(actions)
            if number:
                taken.append(process_time() - begin)
    for environments in made:
        environments.close()
    together, alone = (count / statistics.median(taken) for taken in times)
    return together, alone


def main(arguments: Sequence[str] | None = None) -> None:
    """Print a table."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--nodes', type=int, nargs='+', default=(8, 16, 32), help='along a side')
    parser.add_argument('--count', type=int, default=64, help='cloths')
    parser.add_argument('--rounds', type=int, default=7)
    args = parser.parse_args(arguments)
    print('| nodes of a cloth | `make_vec` | one by one | ratio |')
    print('|---|---|---|---|')
    for nodes in args.nodes:
        together, alone = measure(nodes, args.count, args.rounds)
        print(f'| {nodes} x {nodes} | {together:.0f} /s | {alone:.0f} /s | '
              f'{together / alone:.1f} |', flush=True)


if __name__ == '__main__':
    main()
