# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The fields of a scene with those of the colliders and cameras that it names."""

from collections.abc import Mapping
from typing import Any

from cloth_sim_ros.sim.model.cameras import camera_fields
from cloth_sim_ros.sim.model.colliders import collider_fields
from cloth_sim_ros.sim.model.scene_fields import Field
from cloth_sim_ros.sim.model.scene_fields import SCENE_FIELDS


def all_fields(
        given: Mapping[str, Any], fields: tuple[Field, ...] = SCENE_FIELDS) -> tuple[Field, ...]:
    """Return ``fields`` and those of each collider and camera that ``given`` names."""
    return fields + collider_fields(given) + camera_fields(given)
