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

"""The parameters of a scene that are not the defaults."""

from typing import Any

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_fields import SCENE_FIELDS


def given_values(scene: Scene) -> dict[str, Any]:
    """
    Return what makes ``scene`` again, as plain values: what differs from the defaults.

    What a preset has set is told value by value, so that another one in its place is taken.
    """
    values = {
        field.name: scene[field.name] for field in SCENE_FIELDS
        if field.name != 'preset' and scene[field.name] != field.check(field.default)}
    return {name: list(value) if isinstance(value, tuple) else value
            for name, value in values.items()}
