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
Switch the simulation mode of a running node; positions and velocities are kept.

For example:
  cloth_sim mode mass_spring
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_interfaces.srv import SetMode
from cloth_sim_ros.sim.scene_fields import MODES
from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    parser.add_argument('mode', help=f'one of {", ".join(MODES)}')
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Switch the mode."""
    with open_node(args) as node:
        print(node.call(
            SetMode, 'set_mode', SetMode.Request(mode=args.mode), patient=True,
            waiting=f'compiling shaders for mode {args.mode} ...').message)
    return 0
