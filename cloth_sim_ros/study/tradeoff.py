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

r"""
Measure error against cost of modes and settings on a scene, and choose among them.

For example:
  cloth_sim study tradeoff config/drape.yaml
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_ros.study.runs.arguments import add_run_arguments

TAKES_SCENE = True


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this study."""
    add_run_arguments(parser, 'studies/tradeoff')


def main(args: Namespace) -> int:
    """Make the runs and tell what came out."""
    return 0
