# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Pause a running node: simulated time stops, services still respond.

For example:
  cloth_sim pause
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node
from std_srvs.srv import SetBool


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Pause."""
    with open_node(args) as node:
        print(node.call(SetBool, 'pause', SetBool.Request(data=True)).message)
    return 0
