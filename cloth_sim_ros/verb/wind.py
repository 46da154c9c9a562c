# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Set the steady wind of a running node.

It blows from the end of the step under way until another one is set or the node is reset; gusts
are added to it. The scene must have air (parameter air.density).

For example:
  cloth_sim wind 3 0 0.5
  cloth_sim wind 0 0 0
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.wind import checked_wind
from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node
from geometry_msgs.msg import Vector3
from geometry_msgs.msg import Vector3Stamped
from rcl_interfaces.srv import GetParameters


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    for axis in 'xyz':
        parser.add_argument(
            axis, type=float, metavar=axis.upper(),
            help=f'velocity of the air along {axis}, in the axes of the node [m/s]')
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Set it."""
    wind = checked_wind((args.x, args.y, args.z))
    x, y, z = wind
    with open_node(args) as node:
        request = GetParameters.Request(names=['air.density'])
        density, = node.ask(GetParameters, 'get_parameters', request).values
        if density.double_value <= 0.0:
            raise ClothSimError(
                f'there is no wind in the scene of {cut(args.node)}, which has no air: start it '
                'with air.density above 0, 1.225 at sea level')
        node.tell(
            Vector3Stamped, 'wind', Vector3Stamped(vector=Vector3(x=x, y=y, z=z)),
            'inputs/wind', lambda taken: (taken.vector.x, taken.vector.y, taken.vector.z) == wind)
    print(f'the wind is {x:g} {y:g} {z:g} m/s')
    return 0
