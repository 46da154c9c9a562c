# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
List the fabrics that a scene can name in material.preset.

Needs no node. N/m is the stiffness along rows, along columns and in shear; uN m is the rigidity of
bends along rows and columns. docs/how_to/choose_a_fabric.md lists the measured quantities.

For example:
  cloth_sim materials
  cloth_sim run scene.yaml --set material.preset=denim
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_ros.sim.model.materials import FABRICS
from cloth_sim_ros.sim.model.materials import SOURCE

_HEADER = ('name', 'kg/m2', 'N/m', 'uN m', 'fabric', 'note')


def add_arguments(parser: ArgumentParser) -> None:
    """Add nothing: there is nothing to choose."""


def main(args: Namespace) -> int:
    """Print the table and where its numbers are from."""
    print(materials_table())
    print(f'Measured by {SOURCE}.')
    return 0


def materials_table() -> str:
    """Return the table, a fabric a line."""
    lines = [_HEADER]
    for name, fabric in FABRICS.items():
        lines.append((
            name, f'{fabric.density:.3f}',
            f'{fabric.warp:.0f} {fabric.weft:.0f} {fabric.shear:.0f}',
            ' '.join(f'{1e6 * value:.0f}' for value in fabric.rigidity),
            fabric.fabric, fabric.note))
    widths = [max(map(len, column)) for column in zip(*lines)]
    return '\n'.join(
        '  '.join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip()
        for line in lines)
