# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the modes are compared on, which settings compete, and how little each has to stretch."""

from collections.abc import Mapping
from dataclasses import dataclass
from dataclasses import field
import math
from types import MappingProxyType
from typing import Any

from cloth_sim_ros.sim.scene import Scene

# Light, so that springs have to be stepped often, and dropped, so that it is caught by its pins.
LIGHT_CLOTH: Mapping[str, Any] = MappingProxyType({
    'width': 1.0, 'height': 1.0, 'areal_density': 0.15, 'pins': ('top_left', 'top_right'),
    'start.pose': 'horizontal', 'material.preset': 'none'})
BASELINE = 'mass_spring'
_STRAIN_LIMIT = 0.01


@dataclass(frozen=True)
class StretchBound:
    """
    The most that a cloth may stretch for its speed to be compared.

    :param peak: of Stretch.peak
    :param percentile: of Stretch.worst_frame_percentile
    """

    peak: float
    percentile: float = math.inf

    def __str__(self) -> str:
        """Return the bound in words."""
        text = f'peak <= {100.0 * self.peak:g} %'
        if self.percentile < math.inf:
            text += f', 95th percentile <= {100.0 * self.percentile:g} %'
        return text


@dataclass(frozen=True)
class Contender:
    """
    One way to step the light cloth.

    :param values: scene parameters besides those of the cloth
    :param bound: on its stretch
    """

    name: str
    values: Mapping[str, Any]
    bound: StretchBound = field(default=StretchBound(peak=_STRAIN_LIMIT))

    def scene(self, grid: int) -> Scene:
        """
        Return the light cloth with ``grid`` nodes along each side.

        :raises ClothSimError: when a value is wrong
        """
        return Scene({**LIGHT_CLOTH, 'rows': grid, 'cols': grid, **self.values})


CONTENDERS = {contender.name: contender for contender in (
    Contender(BASELINE, {
        'mode': 'mass_spring', 'stiffness.structural': 1e4, 'stiffness.shear': 1e4}),
    # A step of a frame: substeps follow from how fast edges turn.
    Contender('constraint', {
        'mode': 'constraint', 'constraint.hard': ('structural', 'shear'),
        'constraint.strain': 0.006, 'dt': 0.02}),
    Contender('adaptive', {
        'mode': 'adaptive', 'adaptive.threshold': _STRAIN_LIMIT, 'dt': 0.02,
        'stiffness.structural': 1e3, 'stiffness.shear': 1e3},
        # A limit holds springs where it finds them, which may be somewhat beyond it.
        StretchBound(peak=2.0 * _STRAIN_LIMIT, percentile=1.2 * _STRAIN_LIMIT)),
)}
