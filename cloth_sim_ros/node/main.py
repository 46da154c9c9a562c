# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Start the node, or say in one line why it can't start."""

from collections.abc import Sequence
from itertools import pairwise
import sys
from typing import Any

from cloth_sim_ros.files.checked_yaml import load_yaml
from cloth_sim_ros.files.checked_yaml import parse_yaml
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.node.early_stop import leave_when_interrupted
from cloth_sim_ros.node.missing_module import way_out
from cloth_sim_ros.node.shared_memory import frame_bytes
from cloth_sim_ros.node.shared_memory import picture_bytes
from cloth_sim_ros.node.shared_memory import reclaim_dead_segments
from cloth_sim_ros.node.shared_memory import refuse_ros_without_memory
from cloth_sim_ros.node.shared_memory import use_profile
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.cameras import CAMERA_FIELDS
from cloth_sim_ros.sim.model.scene_fields import SCENE_FIELDS

_DEFAULTS = {field.name: field.default for field in SCENE_FIELDS}
_CAMERA_DEFAULTS = {
    field.name.rpartition('.')[2]: field.default for field in CAMERA_FIELDS}
# Namespaces, node, ros__parameters: no file that ROS takes goes deeper before its names.
_DEEPEST = 16


def grid_of_arguments(args: Sequence[str]) -> tuple[int, int]:
    """
    Return rows and cols of the cloth that the command line ``args`` asks for.

    Of several values, for other nodes too, the largest counts. What cannot be read counts as not
    given: the node refuses it later, and says why.
    """
    given: dict[str, list[int]] = {'rows': [], 'cols': []}
    for option, value in pairwise(args):
        for place, number in _values(option, value):
            name = place.rpartition('.')[2]
            if name in given and type(number) is int and number > 0:
                given[name].append(number)
    rows, cols = (max(found, default=_DEFAULTS[name]) for name, found in given.items())
    return rows, cols


def pictures_of_arguments(args: Sequence[str]) -> tuple[int, int]:
    """
    Return width and height of the largest picture that the command line ``args`` asks for.

    Both are 0 where there is no camera.
    """
    has_cameras = False
    sides: dict[str, list[int]] = {'width': [], 'height': []}
    for option, value in pairwise(args):
        for name, number in _values(option, value):
            *groups, last = name.split('.')
            if 'cameras' not in groups:
                continue
            has_cameras = True
            if last in sides and type(number) is int and number > 0:
                sides[last].append(number)
    if not has_cameras:
        return 0, 0
    width, height = (
        max(found, default=_CAMERA_DEFAULTS[name]) for name, found in sides.items())
    return width, height


def _values(option: str, value: str) -> list[tuple[str, Any]]:
    """Return the names and values that one option of ROS gives, with all groups in dots."""
    try:
        if option in ('-p', '--param'):
            name, _, text = value.partition(':=')
            # NODE:NAME:=VALUE gives it to one node.
            return [(name.rpartition(':')[2], parse_yaml(text, name))]
        if option == '--params-file':
            return _leaves(load_yaml(value))
    except ClothSimError:
        pass
    return []


def _leaves(content: Any, depth: int = 0, prefix: str = '') -> list[tuple[str, Any]]:
    """Return the names and values of a parameter file, of all nodes, with theirs before."""
    if not isinstance(content, dict) or depth > _DEEPEST:
        return []
    found: list[tuple[str, Any]] = []
    for name, value in content.items():
        place = f'{prefix}{name}'
        found += (
            _leaves(value, depth + 1, f'{place}.') if isinstance(value, dict)
            else [(place, value)])
    return found


def main(args: Sequence[str] | None = None) -> int:
    """Run the node until SIGINT or SIGTERM and return the exit code."""
    leave_when_interrupted()
    args = sys.argv if args is None else args
    try:
        # Before ROS starts, and first what gives room to the second.
        reclaimed = reclaim_dead_segments()
        memory = use_profile(max(
            frame_bytes(*grid_of_arguments(args)), picture_bytes(*pictures_of_arguments(args))))
        refuse_ros_without_memory()
        # Imported here, so that a missing ROS or interface package gets an answer as well.
        from cloth_sim_ros.node.process import run_node
        run_node(args, memory, reclaimed)
    except ImportError as error:
        problem = way_out(error)
    except (ClothSimError, DeviceError) as error:
        problem = ' '.join(str(error).split())
    else:
        return 0
    print(f'cloth_sim_node: {problem}', file=sys.stderr)
    return 1
