# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Restore the initial state of a running node: pose, pins, time and scheduled inputs.

For example:
  cloth_sim reset
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node
from std_srvs.srv import Trigger


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Reset."""
    with open_node(args) as node:
        print(node.call(Trigger, 'reset', Trigger.Request()).message)
    return 0
