# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Switch the simulation mode of a running node; positions and velocities are kept.

For example:
  cloth_sim mode mass_spring
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_interfaces.srv import SetMode
from cloth_sim_ros.sim.model.scene_fields import MODES
from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    parser.add_argument('mode', help=f'one of {", ".join(MODES)}')
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Switch the mode."""
    with open_node(args) as node:
        print(node.call(
            SetMode, 'set_mode', SetMode.Request(mode=args.mode), patient=True,
            waiting=f'compiling shaders for mode {args.mode} ...').message)
    return 0
