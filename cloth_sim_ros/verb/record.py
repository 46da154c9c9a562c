# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Start or stop a recording of a running node.

The node writes to a new folder in its recording.directory; start prints the path of that folder.

For example:
  cloth_sim record start
  cloth_sim record start drop_test
  cloth_sim record stop
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node
from std_srvs.srv import Trigger


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    actions = parser.add_subparsers(dest='action', required=True, metavar='start|stop')
    start = actions.add_parser('start', help='start a recording')
    start.add_argument(
        'name', nargs='?', default='', help='name of the folder (default: date and time)')
    stop = actions.add_parser('stop', help='stop the recording')
    for action in (start, stop):
        add_node_arguments(action)


def main(args: Namespace) -> int:
    """Start, or stop."""
    with open_node(args) as node:
        if args.action == 'start':
            request = StartRecording.Request(name=args.name)
            print(node.call(StartRecording, 'start_recording', request).path)
        else:
            print(node.call(Trigger, 'stop_recording', Trigger.Request()).message)
    return 0
