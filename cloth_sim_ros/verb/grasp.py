# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Grasp nodes of the cloth at a point, as a gripper does, move a grasp, or attach it to tf.

The nodes are held rigidly to a frame at the point, and go with it. A grasp moves in a straight
line; its speed is in simulated time. A new target replaces the previous one. Attached to a frame
of tf, it goes where the frame goes, and takes no targets. `cloth_sim release` lets the nodes go.

For example:
  cloth_sim grasp hand --at 0.5 0.5 1 --radius 0.1
  cloth_sim grasp hand --at 0.5 0.5 1 --count 3 --max-force 2
  cloth_sim grasp hand --at 0.5 0.5 1 --radius 0.1 --layers top
  cloth_sim grasp hand --to 0.5 0.5 1.4 --speed 0.3
  cloth_sim grasp hand --at 0 0 0 --frame tool0 --count 4 --follow tool0
  cloth_sim grasp hand --unfollow
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.scene_fields import ALL_LAYERS
from cloth_sim_ros.sim.model.scene_fields import LAYERS
from cloth_sim_ros.verb.following import checked_frame
from cloth_sim_ros.verb.following import follow
from cloth_sim_ros.verb.following import FOLLOW_HELP
from cloth_sim_ros.verb.following import FRAME_HELP
from cloth_sim_ros.verb.following import UNFOLLOW_HELP
from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose
from std_msgs.msg import Header

_AXES = ('X', 'Y', 'Z')
_MOST_NODES = 2**32 - 1
_OF_A_GRASP = ('radius', 'count', 'layers', 'max_force')


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    parser.add_argument('name', metavar='NAME', help='name of the grasp')
    what = parser.add_mutually_exclusive_group()
    what.add_argument(
        '--at', nargs=3, type=float, metavar=_AXES,
        help='grasp the free nodes near this point [m]')
    what.add_argument(
        '--to', nargs=3, type=float, metavar=_AXES, help='target of the grasp [m]')
    what.add_argument('--unfollow', action='store_true', help=UNFOLLOW_HELP)
    parser.add_argument('--follow', metavar='FRAME', help=FOLLOW_HELP)
    parser.add_argument('--frame', metavar='FRAME', help=FRAME_HELP)
    nodes = parser.add_mutually_exclusive_group()
    nodes.add_argument(
        '--radius', type=float, metavar='M', help='grasp all free nodes within it [m]')
    nodes.add_argument(
        '--count', type=int, metavar='N', help='grasp the N nearest free nodes (default: 1)')
    parser.add_argument(
        '--layers', choices=LAYERS,
        help='grasp nodes of all layers of cloth there, or of the top one (default: all)')
    parser.add_argument(
        '--max-force', type=float, metavar='N',
        help='pull of the cloth at which the grasp is lost [N] (default: never)')
    parser.add_argument(
        '--speed', type=float, metavar='M/S',
        help='speed of the move, with --follow alone the largest [m/s] (default: parameter '
             'motion.speed or tf.follow_speed of the node)')
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Grasp, move, attach or detach."""
    if args.at is None and args.to is None:
        print(follow(_following(args), 'follow_grasp'))
    elif args.at is not None:
        with open_node(args) as node:
            print(node.call(Grasp, 'grasp', _grasp(args)).message)
    else:
        request = _move(args)
        with open_node(args) as node:
            print(node.call(MoveFrame, 'move_grasp', request).message)
    return 0


def _following(args: Namespace) -> Namespace:
    if args.follow is None and not args.unfollow:
        raise ClothSimError(
            'there is nothing to do: give --at X Y Z, --to X Y Z, --follow FRAME or --unfollow')
    if args.follow is not None and args.unfollow:
        raise ClothSimError('--follow and --unfollow exclude each other: give one of them')
    _refuse_others(args, '--at X Y Z', (*_OF_A_GRASP, 'frame'))
    _check_speed(args)
    return args


def _grasp(args: Namespace) -> Grasp.Request:
    if args.speed is not None:
        raise ClothSimError('--speed is for a move: give --to X Y Z instead of --at')
    if args.count is not None and not 1 <= args.count <= _MOST_NODES:
        raise ClothSimError(f'--count must be 1 or more, got {args.count}: give a number of nodes')
    for name in ('radius', 'max_force'):
        if getattr(args, name) == 0.0:
            raise ClothSimError(
                f'--{name.replace("_", "-")} must be above 0, got 0: give more, or leave it out')
    return Grasp.Request(
        header=_header(args), name=args.name,
        follow_frame='' if args.follow is None else checked_frame(args.follow),
        pose=_pose(args.at), radius=args.radius or 0.0, count=args.count or 0,
        layers=args.layers or ALL_LAYERS, max_force=args.max_force or 0.0)


def _move(args: Namespace) -> MoveFrame.Request:
    if args.follow is not None:
        raise ClothSimError('--follow goes with --at, or stands alone: leave out --to')
    _refuse_others(args, '--at X Y Z instead of --to', _OF_A_GRASP)
    _check_speed(args)
    return MoveFrame.Request(
        header=_header(args), name=args.name, pose=_pose(args.to), keep_orientation=True,
        speed=args.speed or 0.0)


def _refuse_others(args: Namespace, way_out: str, names: tuple[str, ...]) -> None:
    given = [name for name in names if getattr(args, name) is not None]
    if given:
        raise ClothSimError(
            f'--{given[0].replace("_", "-")} is for a new grasp: give {way_out}')


def _check_speed(args: Namespace) -> None:
    if args.speed == 0.0:
        raise ClothSimError('--speed must be above 0, got 0: give more, or leave it out')


def _header(args: Namespace) -> Header:
    return Header(frame_id=args.frame or '')


def _pose(parts: list[float]) -> Pose:
    return Pose(position=Point(**dict(zip('xyz', parts))))
