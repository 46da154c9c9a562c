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
Pause a running node: simulated time stops, services still respond.

For example:
  cloth_sim pause
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_ros.verb.node_arguments import add_node_arguments
from cloth_sim_ros.verb.node_arguments import open_node
from std_srvs.srv import SetBool


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    add_node_arguments(parser)


def main(args: Namespace) -> int:
    """Pause."""
    with open_node(args) as node:
        print(node.call(SetBool, 'pause', SetBool.Request(data=True)).message)
    return 0
