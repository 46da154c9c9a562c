# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Faces of the cloth that dip into a body between the nodes that touch it.

Contact keeps nodes out of bodies, not what is between them. A point of the cloth that is inside of
a body by no more than the dip is seen in front of the body, and one that is outside and behind is
not (shaders/include/camera/dip.glsl).
"""

import math

from cloth_sim_ros.camera.subject import Subject
from cloth_sim_ros.sim.model.colliders import Collider

# Largest dip over the thickness of a body [1]; chosen: cloth in the middle half of a body, which
# has passed through its surface, is not shown as if it lay on it.
_LARGEST = 0.25


def dip_of(collider: Collider, subject: Subject) -> float:
    """
    Return how deep faces of a cloth can be inside of a body [m].

    That of the longest edge of a cell, a chord over a curve or across an edge of 90 degrees, and
    a thickness of the cloth besides, since edges stretch.
    """
    if collider.shape == 'plane':
        return subject.thickness
    chord = math.hypot(*subject.cell)
    dips = []
    if collider.shape != 'box':
        radius = collider.size[0]
        dips.append(radius - math.sqrt(max(radius * radius - chord * chord / 4.0, 0.0)))
    if collider.shape in ('box', 'cylinder'):
        # Half of the height of the edge over the middle of the chord, as deep on either side.
        dips.append(chord / (2.0 * math.sqrt(2.0)))
    return min(max(dips) + subject.thickness, _LARGEST * collider.thickness)
