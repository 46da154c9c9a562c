# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Pin a node of the cloth at its current position, move a pin, or release it.

A pin moves in a straight line; its speed is in simulated time. A new target replaces the previous
one.

For example:
  cloth_sim pin 0 15
  cloth_sim pin 0 15 --to 0.5 0 1.4 --speed 0.3
  cloth_sim pin 0 15 --release
  cloth_sim pin --near 0.5 0 1
  cloth_sim pin --near 0.5 0 1 --max-distance 0.3
"""

from argparse import ArgumentParser
from argparse import Namespace
from typing import Any

from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node
from geometry_msgs.msg import Point

_LARGEST = 2**32 - 1
_AXES = ('X', 'Y', 'Z')


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    parser.add_argument(
        'place', nargs='*', type=int, metavar='ROW COL',
        help='row and column of the node; row 0 is the top row')
    parser.add_argument(
        '--near', nargs=3, type=float, metavar=_AXES,
        help='select the node nearest to this point or, with --to, the nearest pin [m]')
    parser.add_argument(
        '--max-distance', type=float, metavar='M',
        help='largest accepted distance of that node from the point [m] (default: 0.1, or the '
             'node spacing if that is larger)')
    what = parser.add_mutually_exclusive_group()
    what.add_argument('--release', action='store_true', help='release the node')
    what.add_argument('--to', nargs=3, type=float, metavar=_AXES, help='target of the pin [m]')
    parser.add_argument(
        '--speed', type=float, metavar='M/S',
        help='speed of the move [m/s] (default: parameter pin_speed of the node)')
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Pin, move, or release."""
    place = _place(args)
    if args.to is None:
        kind, name, request = SetPin, 'set_pin', SetPin.Request(release=args.release, **place)
    else:
        kind, name, request = MovePin, 'move_pin', MovePin.Request(
            target=_point(args.to), speed=_given('speed', args.speed), **place)
    with open_node(args) as node:
        print(node.call(kind, name, request).message)
    return 0


def _place(args: Namespace) -> dict[str, Any]:
    if (args.near is None) == (not args.place) or len(args.place) not in (0, 2):
        raise ClothSimError('one node is needed: give ROW COL, or --near X Y Z')
    if args.to is None and args.speed is not None:
        raise ClothSimError('--speed is for a move: give --to X Y Z as well')
    if args.near is None and args.max_distance is not None:
        raise ClothSimError('--max-distance is for a point: give --near X Y Z as well')
    if args.near is not None:
        return {
            'use_point': True, 'point': _point(args.near),
            'max_distance': _given('max_distance', args.max_distance)}
    row, col = args.place
    if not (0 <= row <= _LARGEST and 0 <= col <= _LARGEST):
        raise ClothSimError(f'there is no node ({row}, {col}): rows and columns count from 0')
    return {'row': row, 'col': col}


def _given(name: str, value: float | None) -> float:
    """Return what the node takes for ``value``: to it, 0 says that none is given."""
    if value is None:
        return 0.0
    if value == 0.0:
        raise ClothSimError(
            f'--{name.replace("_", "-")} must be above 0, got 0: give more, or leave it out')
    return value


def _point(parts: list[float]) -> Point:
    return Point(**dict(zip('xyz', parts)))
