# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
What the solver stores of each node: the one table of it, for the buffers and for the shaders.

A field has one vec4 a node. It can have several names, where one purpose is over before the other
begins. The number of a field is its place among those that the system has.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Field:
    """
    One field, or ``count`` fields in a row, of which the shaders know the first.

    :param names: as the shaders have them
    """

    names: tuple[str, ...]
    count: int = 1


# Vectors of every level.
VECTORS = (
    Field(('RESIDUAL',)),
    Field((
        'SMOOTHED',    # after the first step of smoothing
        'DEFECT',      # what that left of RESIDUAL
        'CORRECTED',   # with the correction of the level below, and smoothed again
        'PRODUCT',     # of the cloth: the matrix times PRECONDITIONED
    )),
    Field((
        'SMOOTHED_TWICE',
        'PRECONDITIONED',  # smoothed a last time: the preconditioner applied to RESIDUAL
    )),
)
# Vectors of the cloth alone.
CLOTH_VECTORS = (
    Field(('DIRECTION',)),
    Field(('IMAGE',)),     # the matrix times DIRECTION
    Field(('SOLUTION',)),
    Field(('CHANGE',)),    # of the velocity in the whole step
    Field(('START',)),     # initial solution of a solve that continues another
    Field(('LEFT',)),      # of RESIDUAL, by the pass before
)
# Vectors of the cloth with contact.
CONTACT_VECTORS = (
    Field(('BEGIN_POSITION',)),  # where the substep began
    Field(('BEGIN_VELOCITY',)),  # and with which velocity
    Field(('REACTION',)),        # change of velocity that colliders have made in the substep
    Field(('GIVEN',)),           # impulse that the next solve has to add, over the node mass
    Field(('RIGHT',)),           # the right side, also where a node can't follow it
)
# Vectors of the cloth with thin colliders.
SURFACE_VECTORS = (
    Field(('SURFACE_VALUE',)),  # what cloth_correct.comp has multiplied
)
# System of the cloth.
CLOTH_SYSTEM = (
    Field(('INVERSE',), 2),  # of the node's diagonal block, zero where the node can't move
    Field(('NODE',)),        # position [m], and 1 where free, -1 where pinned
    Field(('ALONG',)),       # of the edges that begin here, along a row, along a column, diagonal,
                             # crossing: what they resist along, less that across, over the square
                             # of the length
    Field(('ACROSS',)),      # what they resist across
    Field(('TENSION',)),     # as found last [m/s2]
    Field(('BEGUN',)),       # as a solve begins with them
)
# With bend edges.
BEND_SYSTEM = (
    Field(('BEND_WEIGHT',)),   # along, along, across, across
    Field(('BEND_TENSION',)),  # found, found, begun, begun
)
# With damped bending: of the lines of three nodes around a node, along a row and a column, the
# direction of their bend, times the root of what damping weighs, and their skew.
BENDING_DAMPING_SYSTEM = (Field(('BENT_LINES',), 2),)
# With contact.
CONTACT_SYSTEM = (
    Field(('CONTACT',)),  # normal of the surface that a node touches, and in which directions that
                          # leaves it free
    Field(('GRIP',)),     # the direction that a node slides in, where friction does not resist, if
                          # any, and what it resists across that, over the node mass
)
# With thin colliders.
SURFACE_SYSTEM = (
    Field(('SURFACE_GROUND',), 2),  # what contacts of edges and faces resist with at a node
)
# System of the coarse levels.
COARSE_SYSTEM = (
    Field(('INVERSE',), 2),
    Field(('GROUND',), 2),  # mass, and what ties the node to pinned ones
    Field(('EDGES',), 6),   # the tensors of the edges that begin here
)


def numbers(*groups: tuple[Field, ...]) -> dict[str, int]:
    """Return the number of each name, the fields of ``groups`` one after the other."""
    found: dict[str, int] = {}
    at = 0
    for field in (field for group in groups for field in group):
        found.update(dict.fromkeys(field.names, at))
        at += field.count
    return found


def count(*groups: tuple[Field, ...]) -> int:
    """Return how many fields there are in ``groups``."""
    return sum(field.count for group in groups for field in group)
