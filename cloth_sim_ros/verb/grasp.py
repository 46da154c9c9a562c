# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Grasp nodes of the cloth at a point, as a gripper does, or move a grasp.

The nodes are held rigidly to a frame at the point, and go with it. A grasp moves in a straight
line; its speed is in simulated time. A new target replaces the previous one. `cloth_sim release`
lets the nodes go.

For example:
  cloth_sim grasp hand --at 0.5 0.5 1 --radius 0.1
  cloth_sim grasp hand --at 0.5 0.5 1 --count 3 --max-force 2
  cloth_sim grasp hand --at 0.5 0.5 1 --radius 0.1 --layers top
  cloth_sim grasp hand --to 0.5 0.5 1.4 --speed 0.3
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.scene_fields import ALL_LAYERS
from cloth_sim_ros.sim.model.scene_fields import LAYERS
from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose

_AXES = ('X', 'Y', 'Z')
_MOST_NODES = 2**32 - 1
_OF_A_GRASP = ('radius', 'count', 'layers', 'max_force')


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    parser.add_argument('name', metavar='NAME', help='name of the grasp')
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument(
        '--at', nargs=3, type=float, metavar=_AXES,
        help='grasp the free nodes near this point [m]')
    what.add_argument(
        '--to', nargs=3, type=float, metavar=_AXES, help='target of the grasp [m]')
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
        help='speed of the move [m/s] (default: parameter motion.speed of the node)')
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Grasp, or move."""
    if args.at is not None:
        with open_node(args) as node:
            print(node.call(Grasp, 'grasp', _grasp(args)).message)
    else:
        request = _move(args)
        with open_node(args) as node:
            print(node.call(MoveFrame, 'move_grasp', request).message)
    return 0


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
        name=args.name, pose=_pose(args.at), radius=args.radius or 0.0, count=args.count or 0,
        layers=args.layers or ALL_LAYERS, max_force=args.max_force or 0.0)


def _move(args: Namespace) -> MoveFrame.Request:
    given = [name for name in _OF_A_GRASP if getattr(args, name) is not None]
    if given:
        raise ClothSimError(
            f'--{given[0].replace("_", "-")} is for a new grasp: give --at X Y Z instead of --to')
    if args.speed == 0.0:
        raise ClothSimError('--speed must be above 0, got 0: give more, or leave it out')
    return MoveFrame.Request(
        name=args.name, pose=_pose(args.to), keep_orientation=True, speed=args.speed or 0.0)


def _pose(parts: list[float]) -> Pose:
    return Pose(position=Point(**dict(zip('xyz', parts))))
