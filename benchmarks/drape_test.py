# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
The drape test of Cusick on measured fabrics: drape coefficients beside published ones.

A disc of 30 cm lies on a plate of 18 cm, config/cusick.yaml. The drape coefficient is the area of
its shadow beyond the plate, over that of the flat disc (ISO 9073-9). Nothing is fitted: weight,
stretch and bending are those that were measured.

For example:
  python benchmarks/drape_test.py
  python benchmarks/drape_test.py --nodes 97 --fabrics denim
"""

from argparse import ArgumentParser
import sys
from time import process_time

from cloth_sim_ros.validation.cusick import drape
from cloth_sim_ros.validation.cusick import FABRICS


def main() -> None:
    """Print the table."""
    parser = ArgumentParser(description=__doc__.partition('\n\n')[0])
    parser.add_argument('--nodes', type=int, nargs='+', default=[49], help='a side')
    parser.add_argument('--fabrics', nargs='+', default=list(FABRICS), choices=list(FABRICS))
    parser.add_argument('--mode', default='mass_spring')
    parser.add_argument('--seconds', type=float, default=10.0, help='at most, simulated')
    args = parser.parse_args()
    for name in args.fabrics:
        changes, kind, published = FABRICS[name]
        told = []
        for nodes in args.nodes:
            begin = process_time()
            found, time = drape(nodes, args.seconds, mode=args.mode, **changes)
            told.append(f'{100.0 * found:.1f}')
            print(f'{name} {nodes}: {100.0 * found:.1f} % at {time:g} s, '
                  f'{process_time() - begin:.0f} s of a processor', file=sys.stderr)
        print(f'| {name} | {" | ".join(told)} | {kind}, {published[0]:g} to '
              f'{published[1]:g} |', flush=True)


if __name__ == '__main__':
    main()
