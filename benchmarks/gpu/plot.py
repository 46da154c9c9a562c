# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Plot the speed of springs by the size of the cloth, from the results of gpu_suite.py.

For example:
  PYTHONPATH=benchmarks python -m gpu.plot docs/notes/gpu/nvidia_h200.json \
    --plot docs/figures/gpu_springs.png
"""

from argparse import ArgumentParser
import json
from pathlib import Path

from matplotlib import pyplot

_UNIT = ' [G node steps/s]'
_NAMES = {'a copy as large': 'a copy of as many bytes', 'default': 'layout: fused',
          'paper': "layout: paper (the paper's two passes)"}


def main() -> None:
    """Write the figure."""
    parser = ArgumentParser(description=__doc__.strip().splitlines()[0])
    parser.add_argument('results', type=Path, help='gpu_suite.json')
    parser.add_argument('--plot', type=Path, required=True, metavar='FILE.png',
                        help='image to write')
    args = parser.parse_args()
    content = json.loads(args.results.read_text(encoding='utf-8'))
    springs = next(each for each in content['sections'] if each['name'] == 'springs')
    rows = [row for row in springs['rows'] if 'nodes' in row]
    figure, axes = pyplot.subplots(figsize=(7.0, 4.2), layout='constrained')
    for name, label in _NAMES.items():
        axes.loglog([row['nodes'] for row in rows], [row[name + _UNIT] for row in rows],
                    marker='o', linestyle='--' if name == 'a copy as large' else '-', label=label)
    axes.set(xlabel='nodes', ylabel='billion node steps per second',
             title=f'Mode mass_spring on {content["device"].partition("/")[0]}')
    axes.grid(alpha=0.3)
    axes.legend()
    figure.savefig(args.plot, dpi=120)


if __name__ == '__main__':
    main()
