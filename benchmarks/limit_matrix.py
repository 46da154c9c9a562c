# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
How mode adaptive holds its limit over sizes, limits, pushes and steps, read after every step.

For example:
  LP_NUM_THREADS=0 python benchmarks/limit_matrix.py --nodes 8 16 32
  LP_NUM_THREADS=0 python benchmarks/limit_matrix.py --nodes 64 --pushes 100 --limits 0.01
"""

from argparse import ArgumentParser
from contextlib import closing
from itertools import product
from time import process_time
from typing import Any

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.energy_account import EnergyAccount
from pushed_scenes import unit_scene

# The push begins at 1 s and lasts 0.2 s.
_SECONDS = 1.6
# Strain over the limit from which on a step has to say that lengths are not held [1].
_REPORTED = 1.2


def row(values: dict[str, Any], seconds: float) -> str:
    """Return what a run of ``seconds`` came to, as cells of a table."""
    with closing(Simulation(Scene(values))) as simulation:
        limit = simulation.scene['adaptive.threshold']
        account, begin = EnergyAccount(simulation), process_time()
        strain, beyond, unreported, steps = 0.0, 0, 0, 0
        while simulation.time < seconds - 1e-9:
            now = account.step()
            if not now.finite:
                return 'state lost | | | | |'
            strain = max(strain, now.max_strain)
            beyond += now.max_strain > _REPORTED * limit
            unreported += now.max_strain > _REPORTED * limit and now.lengths_are_held
            steps += 1
        taken = (process_time() - begin) / simulation.time
        return (f'{strain / limit:.2f} | {beyond} of {steps} | {unreported} '
                f'| {account.gained:.1e} | {taken:.2g}')


def main() -> None:
    """Print a row for each combination."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--nodes', type=int, nargs='+', default=[8, 16, 32], help='a side')
    parser.add_argument('--limits', type=float, nargs='+', default=[0.1, 0.01])
    parser.add_argument(
        '--pushes', type=float, nargs='+', default=[0.0, 5.0, 20.0, 100.0],
        help='over the weight')
    parser.add_argument('--dts', type=float, nargs='+', default=[0.005, 0.02, 0.05], help='[s]')
    parser.add_argument('--scheme', default='constraint', help='adaptive.scheme')
    parser.add_argument('--seconds', type=float, default=_SECONDS, help='simulated, of each run')
    args = parser.parse_args()
    print('| nodes a side | limit | push / weight | dt | largest strain / limit '
          f'| steps beyond {_REPORTED:g} | not reported | energy gained '
          '| processor seconds a second |')
    print('|---|---|---|---|---|---|---|---|---|')
    for nodes, limit, push, dt in product(args.nodes, args.limits, args.pushes, args.dts):
        cells = row(unit_scene(
            nodes, push, dt, **{'adaptive.threshold': limit, 'adaptive.scheme': args.scheme}),
            args.seconds)
        print(f'| {nodes} | {limit:g} | {push:g} | {dt:g} | {cells} |', flush=True)


if __name__ == '__main__':
    main()
