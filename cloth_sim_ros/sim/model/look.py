# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How a cloth and what is around it look to a camera: colours, fabric and sun."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from dataclasses import field
import math
from types import MappingProxyType
from typing import Any

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.arguments import mapping
from cloth_sim_ros.sim.arguments import real_number
from cloth_sim_ros.sim.arguments import vector_or_none
from cloth_sim_ros.sim.arguments import word
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.scene_fields import FABRICS
from cloth_sim_ros.sim.model.scene_fields import SCENE_FIELDS

Color = tuple[float, float, float]

_PREFIX = 'look.'
_DEFAULTS = {
    each.name.removeprefix(_PREFIX): each.default for each in SCENE_FIELDS
    if each.name.startswith(_PREFIX)}
_BODY: Color = (0.66, 0.52, 0.40)   # wood
_FLOOR: Color = (0.86, 0.85, 0.83)


@dataclass(frozen=True)
class Look:
    """
    Colours as a screen has them, red green blue from 0 to 1, and the sun.

    :param fabric: one of FABRICS
    :param color: of the upper side of a flat cloth
    :param back_color: of the other side
    :param second_color: of the ground of checks, or of the weft
    :param pitch: side of a check, or distance of two threads [m]
    :param texture: path of an image that is printed on the side that is up, instead of a fabric;
        empty for none
    :param backdrop: path of an image that fills the picture where nothing is; empty for none
    :param background: where nothing is, without such an image
    :param sun: direction to it in the world, of any length
    :param shadow: radius of the soft edge of a shadow [m]
    :param bodies: colours by the names of colliders; others are of wood, and planes light grey
    :raises ClothSimError: for a wrong value
    """

    fabric: str = _DEFAULTS['fabric']
    color: Color = _DEFAULTS['color']
    back_color: Color = _DEFAULTS['back_color']
    second_color: Color = _DEFAULTS['second_color']
    pitch: float = _DEFAULTS['pitch']
    texture: str = _DEFAULTS['texture']
    backdrop: str = _DEFAULTS['backdrop']
    background: Color = _DEFAULTS['background']
    sun: tuple[float, float, float] = _DEFAULTS['sun']
    shadow: float = _DEFAULTS['shadow']
    bodies: Mapping[str, Color] = field(default_factory=lambda: MappingProxyType({}))

    def __post_init__(self) -> None:
        """Check the values."""
        for name in ('fabric', 'texture', 'backdrop'):
            word(getattr(self, name), f'look.{name}')
        bodies = mapping(self.bodies, 'the colours of bodies', 'give colours by names')
        if self.fabric not in FABRICS:
            raise ClothSimError(
                f'look.fabric must be one of {", ".join(FABRICS)}, got {shown(self.fabric)}')
        colors = {
            'look.color': self.color, 'look.back_color': self.back_color,
            'look.second_color': self.second_color, 'look.background': self.background,
            **{f'colliders.{name}.color': color for name, color in bodies.items()}}
        for name, color in colors.items():
            parts = vector_or_none(color)
            if parts is None or not all(0.0 <= part <= 1.0 for part in parts):
                raise ClothSimError(
                    f'{name} needs red, green and blue from 0 to 1, got {shown(color)}: write '
                    '[0.5, 0.5, 0.5]')
        sun = vector_or_none(self.sun)
        if sun is None or not any(sun) or not math.isfinite(math.hypot(*sun)):
            raise ClothSimError(
                f'look.sun needs a direction [x, y, z], got {shown(self.sun)}: write '
                '[0.0, 0.0, 1.0] for a sun straight above')
        for name, length in (('look.pitch', self.pitch), ('look.shadow', self.shadow)):
            metres = real_number(length, name, 'give a length')
            if not 0.0 < metres < math.inf:
                raise ClothSimError(
                    f'{name} must be a finite length above 0 m, got {metres:g}: give a length')

    def of_body(self, name: str, shape: str) -> Color:
        """Return the colour of a collider."""
        return self.bodies.get(name, _FLOOR if shape == 'plane' else _BODY)


def look_of(values: Mapping[str, Any]) -> Look:
    """
    Return the look that checked scene ``values`` describe.

    :raises ClothSimError: when a value is wrong
    """
    names = values['colliders.names']
    return Look(**{name: values[f'{_PREFIX}{name}'] for name in _DEFAULTS}, bodies={
        name: values[f'colliders.{name}.color'] for name in names
        if values[f'colliders.{name}.color']})
