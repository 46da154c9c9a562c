# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
How a rag of true mass takes the motions of a robot, controlled 10, 100 and 1000 times a second.

For example:
  python benchmarks/motions.py
  python benchmarks/motions.py --paths fling --masses 0.05 --modes constraint --rates 100
"""

from argparse import ArgumentParser
from collections.abc import Iterator
from collections.abc import Sequence

from cloth_sim_ros.sim.model.scene_fields import MODES
from cloth_sim_ros.validation.motions import in_air
from cloth_sim_ros.validation.motions import MASSES
from cloth_sim_ros.validation.motions import move_rag
from cloth_sim_ros.validation.motions import rag
from cloth_sim_ros.validation.motions import RATES
from cloth_sim_ros.validation.robot_paths import PATHS
from cloth_sim_ros.validation.robot_paths import RobotPath


def _rows(
        path: RobotPath, masses: Sequence[float], modes: Sequence[str],
        rates: Sequence[float]) -> Iterator[str]:
    for mass in masses:
        for mode in modes:
            for rate in rates:
                found = move_rag(path, rag(mass, mode, rate))
                yield (
                    f'| {mass:g} | {mode} | {rate:g} | {"yes" if found.finite else "no"} | '
                    f'{100.0 * found.stretch:.2f}, {100.0 * found.shear:.2f} | '
                    f'{1e6 * found.jitter:.4g} | {1e6 * found.rigid:.4g} | '
                    f'{found.acceleration(rate):.2f} | '
                    f'{found.swing:.3f} | {found.substeps} | '
                    f'{1e3 * found.step:.2f}, {1e3 * found.slowest:.2f} |')


def main() -> None:
    """Print the tables of docs/notes/motions.md."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--paths', nargs='+', choices=PATHS, default=list(PATHS))
    parser.add_argument('--masses', type=float, nargs='+', default=MASSES, help='[kg]')
    parser.add_argument('--modes', nargs='+', choices=MODES, default=MODES)
    parser.add_argument('--rates', type=float, nargs='+', default=RATES, help='[Hz]')
    args = parser.parse_args()
    for path in (PATHS[name] for name in args.paths):
        above = in_air(path, rag(MASSES[0], MODES[0], RATES[0]))
        print(f'{path.name}: {path.seconds:g} s, the first {above:.2f} s above the table\n')
        print('| kg | mode | Hz | finite | strain: threads, diagonals [%] | L_s [um] '
              '| L_s of the grippers [um] | [m/s2] | swing [m/s] | substeps '
              '| step: median, 95 % [ms] |')
        print('|' + '---|' * 11)
        for row in _rows(path, args.masses, args.modes, args.rates):
            print(row, flush=True)
        print()


if __name__ == '__main__':
    main()
