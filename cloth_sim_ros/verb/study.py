# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

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

from cloth_sim_ros.verb.scene_arguments import add_scene_arguments
from cloth_sim_ros.verb.scene_arguments import read_scene

# The studies that `cloth_sim study` knows.
#
# A study is a module of cloth_sim_ros.study with `add_arguments(parser)` and
# `main(args) -> int`, the exit code; its docstring is its help text. Where it has
# `TAKES_SCENE = True`, the verb adds SCENE.yaml and --set, and `args.scene` is the Scene when
# main is called.

STUDIES = {
    'tradeoff': 'accuracy-cost trade-off of modes and settings for a scene',
    'presets': 'values of the parameter preset, derived from a tradeoff study',
    'stability': 'measured and predicted stability limits of each mode',
    'extremes': 'robustness against extreme scenes in every mode',
    'answers': 'service response times of a node, also while a mode is compiled',
    'cost': 'cost of each feature of a scene, and the error without it',
}


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
