# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What differs from picture to picture: fabric, start, look and camera, by chance."""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence
import colorsys
from dataclasses import dataclass
from dataclasses import replace
import math
from typing import Any

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.cameras import CameraModel
from cloth_sim_ros.sim.model.cameras import looking_at
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.look import Color
from cloth_sim_ros.sim.model.look import Look
from cloth_sim_ros.sim.model.scene_fields import FABRICS
from cloth_sim_ros.sim.model.scene_fields import MATERIALS
import numpy as np

Range = tuple[float, float]

# What a named fabric brings along, and its scene's values would override.
_OF_FABRIC = ('material.', 'stiffness.', 'damping.', 'bending.')
_MASSES = ('areal_density', 'total_mass', 'node_mass')
# Chosen ranges of looks: value of colours [1], pitch of patterns [m], tilt of the sun [rad].
_VALUES = (0.25, 0.95)
_PITCHES = (0.01, 0.05)
_SUN_TILTS = (0.0, 1.1)
# How far from the middle of the cloth a camera looks, over its distance from there [1].
_OFF_TARGET = 0.08


@dataclass(frozen=True)
class Bounds:
    """
    Between which values a picture's are chosen, evenly.

    :param seconds: simulated before the picture, after the cloth is let go [s]
    :param distance: of the camera from the cloth [m]
    :param elevation: of the camera above the horizon, seen from the cloth [deg]
    :param lift: how high a hand lifts a node before it lets go, over the width of the cloth; 0
        for no hand
    """

    seconds: Range = (0.4, 1.2)
    distance: Range = (0.6, 1.2)
    elevation: Range = (25.0, 80.0)
    lift: Range = (0.0, 0.6)

    def __post_init__(self) -> None:
        """Check the values."""
        for name, low, most in (
                ('seconds', 0.0, 1e3), ('distance', 0.05, 1e3), ('elevation', -89.0, 89.0),
                ('lift', 0.0, 10.0)):
            first, last = getattr(self, name)
            if not low <= first <= last <= most:
                raise ClothSimError(
                    f'--{name} {first:g} {last:g} must be two values from {low:g} to {most:g}, '
                    'the lower one first')


def random_fabric(random: np.random.Generator, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values ``given`` for a scene with one of MATERIALS instead of its fabric."""
    kept = {
        name: value for name, value in given.items()
        if not name.startswith(_OF_FABRIC) and name not in _MASSES}
    return {**kept, 'material.preset': str(random.choice(MATERIALS))}


def random_look(
        random: np.random.Generator, colliders: Sequence[Collider], base: Look) -> Look:
    """Return a look with colours, fabric and sun by chance, and the images of ``base``."""
    tilt, turn = random.uniform(*_SUN_TILTS), random.uniform(0.0, 2.0 * math.pi)
    color = random_color(random)
    hue, saturation, value = colorsys.rgb_to_hsv(*color)
    # The back of a fabric has mostly the dye of its front.
    back = colorsys.hsv_to_rgb(hue, saturation * random.uniform(0.4, 1.0), value)
    return Look(
        texture=base.texture, backdrop=base.backdrop, fabric=str(random.choice(FABRICS)),
        color=color, back_color=back,
        second_color=random_color(random), pitch=float(random.uniform(*_PITCHES)),
        background=random_color(random),
        sun=(math.sin(tilt) * math.cos(turn), math.sin(tilt) * math.sin(turn), math.cos(tilt)),
        shadow=float(random.uniform(0.004, 0.02)),
        bodies={collider.name: random_color(random) for collider in colliders})


def random_color(random: np.random.Generator) -> Color:
    """Return a colour by chance, pale ones as often as strong ones."""
    return colorsys.hsv_to_rgb(
        random.uniform(0.0, 1.0), random.uniform(0.0, 0.8), random.uniform(*_VALUES))


def random_place(
        random: np.random.Generator, camera: CameraModel, nodes: np.ndarray,
        bounds: Bounds) -> CameraModel:
    """
    Return ``camera`` where it looks at the cloth from a direction by chance.

    :param nodes: (n, 3) [m]
    """
    distance = random.uniform(*bounds.distance)
    elevation = math.radians(random.uniform(*bounds.elevation))
    azimuth = random.uniform(0.0, 2.0 * math.pi)
    middle = nodes.mean(axis=0)
    target = middle + random.uniform(-_OFF_TARGET, _OFF_TARGET, 3) * distance
    x, y, z = middle + distance * np.array([
        math.cos(elevation) * math.cos(azimuth), math.cos(elevation) * math.sin(azimuth),
        math.sin(elevation)])
    pose = looking_at((float(x), float(y), float(z)), target.tolist())
    return replace(camera, pose=pose, frame='')
