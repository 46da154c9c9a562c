# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The scene of a study with another number of nodes, or other springs."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from cloth_sim_ros.sim.colliders import fields_with_colliders
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.scene_values import scaled_stiffness


@dataclass(frozen=True)
class Variant:
    """
    A scene that was changed.

    :param resolution: spacings of nodes along each side, over those of the scene
    :param stiffness: of all springs, over that of the scene; their damping stays
    """

    resolution: float = 1.0
    stiffness: float = 1.0

    @property
    def is_scene(self) -> bool:
        """Tell whether nothing was changed."""
        return self == Variant()

    @property
    def name(self) -> str:
        """Return what was changed, in a few words."""
        parts = [f'{name} x {factor:g}' for name, factor in vars(self).items() if factor != 1.0]
        return ', '.join(parts) or 'the scene'

    def values(self, scene: Scene) -> dict[str, Any]:
        """Return the parameters of ``scene`` with the changes, without those at their default."""
        rows, cols = (
            n if n == 1 else max(2, round((n - 1) * self.resolution) + 1)
            for n in (scene.rows, scene.cols))
        changed = {
            **scene.values, 'preset': 'none', 'rows': rows, 'cols': cols,
            'node_mass': scene['node_mass'] * scene.node_count / (rows * cols),
            **scaled_stiffness(scene, self.stiffness)}
        for name in ('pins', 'pin_moves.node'):
            # Two pins may come to be one.
            moved = [_moved(node, scene, rows, cols) for node in scene[name]]
            changed[name] = list(dict.fromkeys(moved)) if name == 'pins' else moved
        return without_defaults(changed)


def without_defaults(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return those of ``values`` that differ from their default, with lists for tuples."""
    given = {
        field.name: values[field.name] for field in fields_with_colliders(values)
        if field.name in values and field.check(values[field.name]) != field.default}
    return {name: list(value) if isinstance(value, tuple) else value
            for name, value in given.items()}


def _moved(node: str, scene: Scene, rows: int, cols: int) -> str:
    row, comma, col = node.partition(',')
    if not comma:
        return node
    return ','.join(
        str(round(int(place) * (new - 1) / max(old - 1, 1)))
        for place, old, new in ((row, scene.rows, rows), (col, scene.cols, cols)))
