# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Resume a paused node.

For example:
  cloth_sim resume
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
    """Resume."""
    with open_node(args) as node:
        print(node.call(SetBool, 'pause', SetBool.Request(data=False)).message)
    return 0
