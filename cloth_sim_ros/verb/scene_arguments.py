# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The arguments of verbs that simulate, and what they say of the scene."""

from argparse import Action
from argparse import ArgumentParser
from argparse import Namespace
import os
from typing import Any

from cloth_sim_ros.api.scene_file import scene_from
from cloth_sim_ros.files.checked_yaml import parse_yaml
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.device.tuning import OFF
from cloth_sim_ros.sim.device.tuning import VARIABLE
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.scene import Scene


def add_scene_arguments(parser: ArgumentParser) -> None:
    """Add the scene file, --params and --set."""
    parser.add_argument('scene', metavar='SCENE.yaml', help='ROS parameter file of the scene')
    parser.add_argument('--params', action='append', default=[], metavar='PARAMS.yaml',
                        help='parameter file that overrides the scene; can be given several '
                             'times')
    parser.add_argument('--set', action='append', default=[], metavar='name=value', dest='changes',
                        help='set a parameter; can be given several times')
    add_tuning_argument(parser)


def add_tuning_argument(parser: ArgumentParser) -> None:
    """Add --no-tune."""
    parser.add_argument('--no-tune', action=_WithoutTuning, nargs=0,
                        help='use the built-in loads and block, not what `cloth_sim tune` has '
                             'found')


class _WithoutTuning(Action):
    """Has this process, and those that it starts, use no tuning."""

    def __call__(self, *_: object) -> None:
        """Set the variable of the environment that does so."""
        os.environ[VARIABLE] = OFF


def read_scene(args: Namespace) -> tuple[Scene, dict[str, Any]]:
    """
    Return the scene and the node's parameters that the arguments describe.

    :raises ClothSimError: when the file or a --set is not right
    """
    given: dict[str, Any] = {}
    for path in args.params:
        given.update(load_parameters(path))
    given.update(map(parse_change, args.changes))
    return scene_from(args.scene, given)


def parse_change(change: str) -> tuple[str, Any]:
    """Return name and value of ``name=value``; ClothSimError when it is none."""
    name, separator, text = change.partition('=')
    if not separator or not name:
        raise ClothSimError(f'a change needs name=value, got {shown(change)}')
    return name.strip(), parse_yaml(text, f'the value of {cut(name)}')
