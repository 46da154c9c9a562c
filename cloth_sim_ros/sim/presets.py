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
