# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
Reproduce a table or a figure of the paper: its speeds, or its pictures of a pushed cloth.

table10, fig7, fig8 and fig9 time the cloths of the paper on this device and beside it in plain
serial C. fig10 and fig11 record runs and draw them. docs/notes/paper.md discusses the results.

For example:
  cloth_sim paper table10
  cloth_sim paper fig8 --plot fig8.png
  cloth_sim paper fig10 --sheet fig10.png
  cloth_sim paper table10 --help
"""

from argparse import ArgumentParser
from argparse import Namespace
from argparse import RawDescriptionHelpFormatter
from importlib import import_module
from types import ModuleType

# The module that makes each figure, with `add_arguments(parser, figure)` and
# `main(args) -> int`.
FIGURES = {
    'table10': ('paper_speeds', 'frame rates of the CPU and of GLSL, and the real-time limits'),
    'fig7': ('paper_speeds', 'frame rates of mode mass_spring over the nodes'),
    'fig8': ('paper_speeds', 'frame rates of mode constraint over the nodes'),
    'fig9': ('paper_speeds', 'frame rates of mode adaptive over the nodes'),
    'fig10': ('paper_pictures', 'three modes pushed hard, dt = 0.005 s'),
    'fig11': ('paper_pictures', 'constraint and adaptive pushed hard, dt = 0.01 and 0.02 s'),
}


def add_arguments(parser: ArgumentParser) -> None:
    """Add the figures and their arguments."""
    figures = parser.add_subparsers(dest='figure', metavar='FIGURE', required=True)
    for name, (_, text) in FIGURES.items():
        module = _module(name)
        module.add_arguments(figures.add_parser(
            name, help=text, description=module.__doc__,
            formatter_class=RawDescriptionHelpFormatter), name)


def main(args: Namespace) -> int:
    """Make the figure asked for."""
    return _module(args.figure).main(args)


def _module(figure: str) -> ModuleType:
    return import_module(f'cloth_sim_ros.verb.{FIGURES[figure][0]}')
