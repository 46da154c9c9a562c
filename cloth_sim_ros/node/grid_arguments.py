# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How many nodes the ROS arguments ask for, read before there is a ROS node that could tell."""

from collections.abc import Iterator
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from cloth_sim_ros.files.checked_yaml import load_yaml
from cloth_sim_ros.files.checked_yaml import parse_yaml
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene_fields import SCENE_FIELDS

_DEFAULTS = {field.name: field.default for field in SCENE_FIELDS}
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
        for name, number in _values(option, value):
            if name in given and type(number) is int and number > 0:
                given[name].append(number)
    rows, cols = (max(found, default=_DEFAULTS[name]) for name, found in given.items())
    return rows, cols


def _values(option: str, value: str) -> Iterator[tuple[str, Any]]:
    """Yield the names and values that one option of ROS gives."""
    try:
        if option in ('-p', '--param'):
            name, _, text = value.partition(':=')
            # NODE:NAME:=VALUE gives it to one node.
            yield name.rpartition(':')[2], parse_yaml(text, name)
        elif option == '--params-file':
            yield from _leaves(load_yaml(value))
    except ClothSimError:
        return


def _leaves(content: Any, depth: int = 0) -> Iterator[tuple[str, Any]]:
    if not isinstance(content, dict) or depth > _DEEPEST:
        return
    for name, value in content.items():
        if isinstance(value, dict):
            yield from _leaves(value, depth + 1)
        else:
            yield str(name), value
