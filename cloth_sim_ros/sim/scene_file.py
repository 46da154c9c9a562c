# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Read a ROS parameter file into dotted names, without ROS."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cloth_sim_ros.files.checked_yaml import load_yaml
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.sim.errors import ClothSimError


def load_parameters(path: str | Path) -> dict[str, Any]:
    """
    Return the parameters of a ROS parameter YAML as dotted names and values.

    Every node section of the file is taken, later ones over earlier ones; within one, each
    parameter stands once.

    :raises ClothSimError: when the file can't be read or is no parameter file
    """
    document = load_yaml(path)
    if not isinstance(document, Mapping):
        raise ClothSimError(
            f'{cut(path)} holds no parameters: write "/**: {{ros__parameters: ...}}"')
    parameters: dict[str, Any] = {}
    for section in document.values():
        if not isinstance(section, Mapping) or not isinstance(
                section.get('ros__parameters'), Mapping):
            raise ClothSimError(
                f'{cut(path)} has a section without ros__parameters: '
                'write "/**: {ros__parameters: ...}"')
        names: dict[str, Any] = {}
        _flatten(section['ros__parameters'], '', names, path)
        parameters.update(names)
    return parameters


def _flatten(
        tree: Mapping[str, Any], prefix: str, into: dict[str, Any], path: str | Path) -> None:
    for key, value in tree.items():
        name = f'{prefix}{key}'
        if isinstance(value, Mapping):
            _flatten(value, f'{name}.', into, path)
        elif name in into:
            raise ClothSimError(
                f'{path} has the parameter {cut(name)} twice, nested and with a dot: '
                'keep one')
        else:
            into[name] = value
