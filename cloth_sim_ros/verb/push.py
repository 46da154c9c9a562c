# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Push the cloth of a running node with a total force, or cancel all pushes.

The force is distributed over all free nodes or, with --center, over those within --radius of that
point. The duration is in simulated time.

For example:
  cloth_sim push --force 0 0 2.5 --duration 0.2
  cloth_sim push --force 1 0 0 --center 0.2 0 1 --radius 0.15
  cloth_sim push --clear
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_interfaces.msg import Push
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node
from geometry_msgs.msg import Point
from geometry_msgs.msg import Vector3
from std_srvs.srv import Trigger

_AXES = ('X', 'Y', 'Z')


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument('--force', nargs=3, type=float, metavar=_AXES, help='total force [N]')
    what.add_argument('--clear', action='store_true', help='cancel all pushes instead')
    parser.add_argument(
        '--center', nargs=3, type=float, metavar=_AXES, help='centre of the pushed sphere [m]')
    parser.add_argument(
        '--radius', type=float, default=0.1, metavar='M',
        help='radius of the pushed sphere [m] (default: %(default)s)')
    parser.add_argument(
        '--duration', type=float, default=0.1, metavar='S',
        help='duration of the push [s] (default: %(default)s)')
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Push, or clear."""
    with open_node(args) as node:
        if args.clear:
            print(node.call(Trigger, 'clear_pushes', Trigger.Request()).message)
            return 0
        response = node.call(ApplyPush, 'apply_push', _request(args))
        impulse = response.impulse
        print(f'{response.message}, impulse '
              f'{impulse.x:.6g} {impulse.y:.6g} {impulse.z:.6g} N s')
    return 0


def _request(args: Namespace) -> ApplyPush.Request:
    request = ApplyPush.Request(
        force=Vector3(**_by_axis(args.force)), region=Push.ALL, duration=args.duration)
    if args.center is not None:
        request.region = Push.SPHERE
        request.center = Point(**_by_axis(args.center))
        request.radius = args.radius
    return request


def _by_axis(vector: list[float]) -> dict[str, float]:
    return dict(zip('xyz', vector))
