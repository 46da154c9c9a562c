# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Release a grasp of the cloth, or all of them.

The nodes keep the velocity that they have. `cloth_sim pin ROW COL --release` releases a pin.

For example:
  cloth_sim release hand
  cloth_sim release
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_interfaces.srv import Release
from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    parser.add_argument(
        'name', nargs='?', default='', metavar='NAME', help='name of the grasp (default: all)')
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Release."""
    with open_node(args) as node:
        print(node.call(Release, 'release', Release.Request(name=args.name)).message)
    return 0
