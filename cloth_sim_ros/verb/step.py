# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Advance a paused node by a number of time steps and wait for them to finish.

The node publishes and records a frame after the last step and, with --every, in between.

For example:
  cloth_sim step
  cloth_sim step 200
  cloth_sim step 200 --every 4
"""

from argparse import ArgumentParser
from argparse import ArgumentTypeError
from argparse import Namespace

from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node

_LARGEST = 2**32 - 1


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    parser.add_argument(
        'steps', nargs='?', type=_count, default=1,
        help='number of time steps (default: %(default)s)')
    parser.add_argument(
        '--every', type=_count, metavar='N',
        help='also publish and record a frame after every N steps')
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Step."""
    every = args.every or args.steps
    with open_node(args) as node:
        left = args.steps
        while True:
            request = Step.Request(steps=min(every, left))
            answer = node.call(Step, 'step', request, patient=True)
            left -= request.steps
            if left <= 0:
                break
    if every < args.steps:
        print(f'{args.steps} steps done, {every} at a time, now at {answer.sim_time:.6g} s')
    else:
        print(answer.message)
    return 0


def _count(text: str) -> int:
    count = int(text)
    if not 0 <= count <= _LARGEST:
        raise ArgumentTypeError(f'{count} is outside 0 to {_LARGEST}')
    return count
