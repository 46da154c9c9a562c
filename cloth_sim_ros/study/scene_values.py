# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The parameters of a scene: those that are not the defaults, and springs times a factor."""

from typing import Any

from cloth_sim_ros.sim.model.named_fields import all_fields
from cloth_sim_ros.sim.scene import Scene


def given_values(scene: Scene) -> dict[str, Any]:
    """
    Return the plain values that reproduce ``scene``: those that differ from the defaults.

    Values set by a preset are written one by one, so that a later preset can override them. The
    material is always written: without it the default fabric would replace default springs.
    """
    values = {
        field.name: scene[field.name] for field in all_fields(scene.values)
        if field.name == 'material.preset' or (
            field.name != 'preset' and scene[field.name] != field.check(field.default))}
    return {name: list(value) if isinstance(value, tuple) else value
            for name, value in values.items()}


def scaled_stiffness(scene: Scene, factor: float) -> dict[str, Any]:
    """Return the parameters of ``scene`` that say how stiff its springs are, times ``factor``."""
    return _scaled(scene, ('stiffness.', 'material.'), factor)


def scaled_damping(scene: Scene, factor: float) -> dict[str, Any]:
    """Return the parameters of ``scene`` that say how its springs are damped, times ``factor``."""
    return _scaled(scene, ('damping.',), factor)


def _scaled(scene: Scene, groups: tuple[str, ...], factor: float) -> dict[str, Any]:
    given = {
        name: value for name, value in scene.values.items()
        if name.startswith(groups) and not isinstance(value, str)}
    return {
        name: [factor * part for part in value] if isinstance(value, tuple) else factor * value
        for name, value in given.items()}
