# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Time of a substep with compensated sums over that of one with plain sums, in mode mass_spring.

For example:
  LP_NUM_THREADS=0 python benchmarks/short_steps.py
"""

import argparse
import statistics

from cloth_sim_ros.sim.device.low_parts import needs_low_parts
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.speed import time_steps

# Substeps of 2 us need compensation at 1 m only where dt is as short.
SUBSTEPS = 2000
SHORT = {'dt': 2e-6, 'substeps': 1}
LONG = {'dt': 4e-3, 'substeps': SUBSTEPS}


def main() -> None:
    """Print the ratio for each size."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--sizes', type=int, nargs='+', default=[32, 64, 128], metavar='N')
    parser.add_argument('--rounds', type=int, default=7)
    arguments = parser.parse_args()
    for size in arguments.sizes:
        # Without air, which is found once in each dt.
        common = {'rows': size, 'cols': size, 'auto_substeps': False, 'air.density': 0.0}
        short, long = (Simulation(Scene({**common, **steps})) for steps in (SHORT, LONG))
        assert needs_low_parts(short.scene) and not needs_low_parts(long.scene)
        ratios = []
        for _ in range(arguments.rounds):
            plain = time_steps(long, 1)
            ratios.append(time_steps(short, SUBSTEPS) / plain)
        print(f'{size} x {size}: {statistics.median(ratios):.2f} '
              f'({min(ratios):.2f} to {max(ratios):.2f})', flush=True)
        short.close()
        long.close()


if __name__ == '__main__':
    main()
