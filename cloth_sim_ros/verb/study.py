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
Measure error, cost and stability limits of a scene, and choose settings.

For example:
  cloth_sim study tradeoff config/drape.yaml
  cloth_sim study tradeoff config/drape.yaml --budget-rtf 1 --out studies/drape
  cloth_sim study stability config/drape.yaml
  cloth_sim study extremes
  cloth_sim study cost config/drape.yaml --passes
  cloth_sim study tradeoff --help
"""

from argparse import ArgumentParser
from argparse import Namespace
from argparse import RawDescriptionHelpFormatter
from importlib import import_module
from types import ModuleType

from cloth_sim_ros.study.studies import STUDIES
from cloth_sim_ros.verb.scene_arguments import add_scene_arguments
from cloth_sim_ros.verb.scene_arguments import read_scene


def add_arguments(parser: ArgumentParser) -> None:
    """Add the studies and their arguments."""
    studies = parser.add_subparsers(dest='study', metavar='STUDY', required=True)
    for name, text in STUDIES.items():
        study = _module(name)
        own = studies.add_parser(
            name, help=text, description=study.__doc__,
            formatter_class=RawDescriptionHelpFormatter)
        if _takes_scene(study):
            add_scene_arguments(own)
        study.add_arguments(own)


def main(args: Namespace) -> int:
    """Run the study asked for."""
    study = _module(args.study)
    if _takes_scene(study):
        args.scene_file, args.scene = args.scene, read_scene(args)[0]
    return study.main(args)


def _module(name: str) -> ModuleType:
    return import_module(f'cloth_sim_ros.study.{name}')


def _takes_scene(study: ModuleType) -> bool:
    return getattr(study, 'TAKES_SCENE', False)
