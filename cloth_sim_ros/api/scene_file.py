# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Scenes of parameter files, which hold parameters of the node as well."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cloth_sim_ros.node.node_fields import checked_node_values
from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.sim.arguments import mapping
from cloth_sim_ros.sim.arguments import path as checked_path
from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.model.named_fields import all_fields
from cloth_sim_ros.sim.scene import refuse_unknown
from cloth_sim_ros.sim.scene import Scene


def load_scene(path: str | Path, changes: Mapping[str, Any] | None = None) -> Scene:
    """
    Return the scene of a ROS parameter file; parameters of the node alone are ignored.

    :param changes: parameters that override those of the file, by dotted name
    :raises ClothSimError: when the file can't be read, or a parameter in it or in ``changes`` is
        not right
    """
    given = {} if changes is None else mapping(
        changes, 'the changes of a scene', "give parameters by name, {'rows': 32}")
    return scene_from(checked_path(path, 'the scene file'), given)[0]


def scene_from(
        path: str | Path, changes: Mapping[str, Any]) -> tuple[Scene, dict[str, Any]]:
    """
    Return the scene and the node's parameters of a file with ``changes`` by name.

    :raises ClothSimError: when the file or a change is not right
    """
    given = {**load_parameters(path), **changes}
    fields = all_fields(given)
    refuse_unknown(given, fields + NODE_FIELDS)
    node_values = checked_node_values(given)
    names = {field.name for field in fields}
    return Scene({name: value for name, value in given.items() if name in names}), node_values
