# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Presets: choices of how to step a scene that a study has measured."""

from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

from cloth_sim_ros.gl.shared_directory import shared_directory
from cloth_sim_ros.sim.scene_fields import PRESETS
from cloth_sim_ros.sim.scene_file import load_parameters


def with_preset(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return ``given`` with the values of its preset for what it leaves out."""
    name = given.get('preset')
    # What is no preset is left to the check of the field.
    return {**(_values(name) if name in PRESETS else {}), **given}


@cache
def _values(name: str) -> Mapping[str, Any]:
    path = shared_directory('config') / 'presets' / f'{name}.yaml'
    return MappingProxyType(load_parameters(path))
