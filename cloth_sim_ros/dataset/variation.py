# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Random variations of samples besides look and camera: fabric and start."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from cloth_sim_ros.camera.randomise import DISTANCE
from cloth_sim_ros.camera.randomise import ELEVATION
from cloth_sim_ros.camera.randomise import Range
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.scene_fields import MATERIALS
import numpy as np

# What a named fabric brings along, and its scene's values would override.
_OF_FABRIC = ('material.', 'stiffness.', 'damping.', 'bending.')
_MASSES = ('areal_density', 'total_mass', 'node_mass')


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
    distance: Range = DISTANCE
    elevation: Range = ELEVATION
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
