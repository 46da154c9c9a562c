# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Measure scenes with a known outcome on this device, and print a table.

Each row has a formula, an independent solution or a published measurement beside the figures of
all modes, and how far off is allowed. Figures beyond that are in bold. docs/validation.md is this
table. Without --long, rows that take minutes are left out.

The exit code is 1 if a figure is off without a known reason.

For example:
  cloth_sim validate
  cloth_sim validate --only strips friction.capstan --modes constraint
  cloth_sim validate --long --out docs/validation.md
"""

from argparse import ArgumentParser
from argparse import Namespace
from contextlib import closing
from pathlib import Path

from cloth_sim_ros.files.generated_page import GeneratedPage
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.model.scene_fields import MODES
from cloth_sim_ros.validation.table import BEGIN
from cloth_sim_ros.validation.table import chosen
from cloth_sim_ros.validation.table import END
from cloth_sim_ros.validation.table import markdown
from cloth_sim_ros.validation.table import measure
from tqdm import tqdm


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    parser.add_argument('--only', nargs='+', default=[], metavar='ROW',
                        help='rows or families of rows, as strips or strips.sag (default: all)')
    parser.add_argument('--modes', nargs='+', choices=MODES, default=list(MODES),
                        metavar='MODE', help=f'of {", ".join(MODES)} (default: all)')
    parser.add_argument('--long', action='store_true', help='measure the rows that take minutes')
    parser.add_argument('--out', type=Path, metavar='FILE.md',
                        help='write the table there; a page that has one keeps its other text')


def main(args: Namespace) -> int:
    """Measure, print and write."""
    rows = chosen(args.only, is_long=args.long)
    page = GeneratedPage(args.out, BEGIN, END) if args.out else None
    found = []
    with closing(Context(single_thread=True)) as context, tqdm(
            total=sum(len(row.grids) for row in rows), unit=' rows', leave=False,
            disable=None) as bar:
        for each in measure(context, rows, args.modes):
            found.append(each)
            bar.set_description(each.row.name)
            bar.update()
    text = markdown(found)
    print(text, end='')
    if page:
        page.write(text)
    return int(any(each.failed and not each.row.shortfall for each in found))
