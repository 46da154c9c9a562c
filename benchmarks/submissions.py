# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Count the dispatches, barriers and waits of a substep, by mode and scene.

For example:
  python benchmarks/submissions.py
  python benchmarks/submissions.py --as-gpu
"""

from argparse import ArgumentParser

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.model.scene_fields import MODES
from gpu.submissions import rows


def main() -> None:
    """Print the table of docs/notes/performance.md."""
    parser = ArgumentParser(description=__doc__.strip().splitlines()[0])
    parser.add_argument('--as-gpu', action='store_true',
                        help='submit what a GPU would be given, whatever the device is')
    parser.add_argument('--mode', choices=MODES, default='', help='count this one alone')
    given = parser.parse_args()
    context = Context()
    if given.as_gpu:
        context.is_software = False
    for number, row in enumerate(rows(context, only=given.mode)):
        if number == 0:
            print(f'| {" | ".join(row)} |\n|{"---|" * len(row)}')
        cells = (f'{value:.3g}' if isinstance(value, float) else str(value)
                 for value in row.values())
        print(f'| {" | ".join(cells)} |', flush=True)
    context.close()


if __name__ == '__main__':
    main()
