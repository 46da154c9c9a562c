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
Restore the initial state of a running node: pose, pins, time and scheduled inputs.

For example:
  cloth_sim reset
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node
from std_srvs.srv import Trigger


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Reset."""
    with open_node(args) as node:
        print(node.call(Trigger, 'reset', Trigger.Request()).message)
    return 0
