# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
Hold a node of the cloth where it is, or let it go.

For example:
  cloth_sim pin 0 15
  cloth_sim pin 0 15 --release
  cloth_sim pin --near 0.5 0 1
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_interfaces.srv import SetPin
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node
from geometry_msgs.msg import Point

_LARGEST = 2**32 - 1


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    parser.add_argument(
        'place', nargs='*', type=int, metavar='ROW COL', help='the node, row 0 is the top one')
    parser.add_argument(
        '--near', nargs=3, type=float, metavar=('X', 'Y', 'Z'),
        help='take the node nearest to this point [m]')
    parser.add_argument('--release', action='store_true', help='let the node go')
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Pin, or release."""
    request = _request(args)
    with open_node(args) as node:
        print(node.call(SetPin, 'set_pin', request).message)
    return 0


def _request(args: Namespace) -> SetPin.Request:
    if (args.near is None) == (not args.place) or len(args.place) not in (0, 2):
        raise ClothSimError('one node is needed: give ROW COL, or --near X Y Z')
    if args.near is not None:
        x, y, z = args.near
        return SetPin.Request(use_point=True, point=Point(x=x, y=y, z=z), release=args.release)
    row, col = args.place
    if not (0 <= row <= _LARGEST and 0 <= col <= _LARGEST):
        raise ClothSimError(f'there is no node ({row}, {col}): rows and columns count from 0')
    return SetPin.Request(row=row, col=col, release=args.release)
