# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The options that say which node a verb talks to."""

from argparse import ArgumentParser
from argparse import Namespace
import os
import sys
from typing import TYPE_CHECKING

from cloth_sim_ros.node.shared_memory import leave_out_memory

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
    _keep_stdout_for_answers()
    use_the_memory_there_is()
    return NodeClient(args.node, args.timeout)


def use_the_memory_there_is() -> None:
    """Do without shared memory where there is no room for it, and say so; before ROS starts."""
    lack = leave_out_memory()
    if lack:
        print(f'cloth_sim: {lack}', file=sys.stderr)


def _keep_stdout_for_answers() -> None:
    """
    Send to stderr what libraries print, from now on.

    Fast DDS prints its errors to stdout, where a script reads the answer of a verb.
    """
    out = sys.__stdout__
    # A stream is None where the caller has closed it.
    if out is None or sys.stdout is not out or sys.stderr is None:
        return
    out.flush()
    answers = os.dup(out.fileno())
    os.dup2(sys.stderr.fileno(), out.fileno())
    sys.stdout = os.fdopen(answers, 'w', encoding=out.encoding, errors=out.errors)
