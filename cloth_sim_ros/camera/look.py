# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How a cloth and what is around it look: colours, fabric and sun."""

from collections.abc import Mapping
from dataclasses import dataclass
from dataclasses import field
from types import MappingProxyType

Color = tuple[float, float, float]

# Fabrics: of one colour, in checks of two, or of warp and weft in two.
PLAIN, CHECKED, WOVEN = FABRICS = ('plain', 'checked', 'woven')
_DEFINES: Mapping[str, Mapping[str, int]] = {
    PLAIN: {}, CHECKED: {'HAS_PATTERN': 1, 'CHECKED': 1}, WOVEN: {'HAS_PATTERN': 1, 'WOVEN': 1}}
_BODY: Color = (0.66, 0.52, 0.40)   # wood
_FLOOR: Color = (0.86, 0.85, 0.83)


@dataclass(frozen=True)
class Look:
    """
    Colours as a screen has them, red green blue from 0 to 1, and the sun.

    :param fabric: one of FABRICS
    :param front: of the side that is up when the cloth lies flat
    :param back: of the other side
    :param second: of the ground of checks, or of the weft
    :param pitch: side of a check, or distance of two threads [m]
    :param background: where nothing is
    :param bodies: by the names of colliders; others are of wood, and planes of a light grey
    :param sun: direction to it in the world, of any length
    :param softness: radius of the soft edge of a shadow [m]
    """

    fabric: str = PLAIN
    front: Color = (0.45, 0.60, 0.76)
    back: Color = (0.52, 0.64, 0.77)
    second: Color = (0.97, 0.96, 0.93)
    pitch: float = 0.04
    background: Color = (0.75, 0.80, 0.86)
    bodies: Mapping[str, Color] = field(default_factory=lambda: MappingProxyType({}))
    sun: tuple[float, float, float] = (0.4, 0.5, 1.0)
    softness: float = 0.008

    @property
    def defines(self) -> Mapping[str, int]:
        """Return what shaders need that draw the fabric."""
        return _DEFINES[self.fabric]

    def of_body(self, name: str, shape: str) -> Color:
        """Return the colour of a collider."""
        return self.bodies.get(name, _FLOOR if shape == 'plane' else _BODY)
