# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Move a collider of a running node, turn it, or attach it to a frame of tf.

It moves in a straight line and turns about one axis; its speeds are in simulated time. A new
target replaces the previous one. Without --orientation it is not turned. Attached to a frame, it
goes where the frame goes, and takes no targets.

For example:
  cloth_sim collider table --to 0 0 1
  cloth_sim collider table --to 0 0 1 --speed 0.2
  cloth_sim collider table --to 0 0 1 --orientation 0 0 0.7071 0.7071 --angular-speed 0.5
  cloth_sim collider finger --follow finger_link --speed 0.5
  cloth_sim collider finger --unfollow
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.verb.following import follow
from cloth_sim_ros.verb.following import FOLLOW_HELP
from cloth_sim_ros.verb.following import UNFOLLOW_HELP
from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose
from geometry_msgs.msg import Quaternion

_AXES = ('X', 'Y', 'Z')


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    parser.add_argument('name', metavar='NAME', help='name of the collider in the scene')
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument(
        '--to', nargs=3, type=float, metavar=_AXES, help='target of its centre [m]')
    what.add_argument('--follow', metavar='FRAME', help=FOLLOW_HELP)
    what.add_argument('--unfollow', action='store_true', help=UNFOLLOW_HELP)
    parser.add_argument(
        '--orientation', nargs=4, type=float, metavar=(*_AXES, 'W'),
        help='orientation at the end, as a quaternion (default: do not turn)')
    parser.add_argument(
        '--speed', type=float, metavar='M/S',
        help='speed of the move, with --follow the largest [m/s] (default: parameter '
             'motion.speed or tf.follow_speed of the node)')
    parser.add_argument(
        '--angular-speed', type=float, metavar='RAD/S',
        help='speed of the turn, with --follow the largest [rad/s] (default: parameter '
             'motion.angular_speed or tf.follow_angular_speed of the node)')
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Move, attach or detach."""
    _check_speeds(args)
    if args.to is None:
        print(follow(args, 'follow_collider'))
        return 0
    request = _move(args)
    with open_node(args) as node:
        print(node.call(MoveFrame, 'move_collider', request).message)
    return 0


def _check_speeds(args: Namespace) -> None:
    if args.to is None and args.orientation is not None:
        raise ClothSimError('--orientation is for a move: give --to X Y Z as well')
    if args.to is not None and args.orientation is None and args.angular_speed is not None:
        raise ClothSimError('--angular-speed is for a turn: give --orientation X Y Z W as well')
    for name in ('speed', 'angular_speed'):
        # To the node, 0 says that none is given.
        if getattr(args, name) == 0.0:
            raise ClothSimError(
                f'--{name.replace("_", "-")} must be above 0, got 0: give more, or leave it out')


def _move(args: Namespace) -> MoveFrame.Request:
    pose = Pose(position=Point(**dict(zip('xyz', args.to))))
    if args.orientation is not None:
        pose.orientation = Quaternion(**dict(zip('xyzw', args.orientation)))
    return MoveFrame.Request(
        name=args.name, pose=pose, keep_orientation=args.orientation is None,
        speed=args.speed or 0.0, angular_speed=args.angular_speed or 0.0)
