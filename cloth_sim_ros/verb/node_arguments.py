# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The options that say which node a verb talks to."""

from argparse import ArgumentParser
from argparse import Namespace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cloth_sim_ros.verb.node_client import NodeClient


def add_node_arguments(parser: ArgumentParser) -> None:
    """Add the options that say which node is meant."""
    group = parser.add_argument_group('node')
    group.add_argument(
        '--node', default='cloth_sim', metavar='NAME',
        help='name of the node, including its namespace (default: %(default)s)')
    group.add_argument(
        # Nodes of a graph may need 3 s to find each other.
        '--timeout', type=float, default=10.0, metavar='S',
        help='wall time to wait for a response [s] (default: %(default)s)')


def open_node(args: Namespace) -> 'NodeClient':
    """Return the node that the options of add_node_arguments mean."""
    # A verb may do without a node, and then without ROS.
    from cloth_sim_ros.verb.node_client import NodeClient
    return NodeClient(args.node, args.timeout)
