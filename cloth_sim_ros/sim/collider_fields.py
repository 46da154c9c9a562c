# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The parameters of the colliders that a scene names: the same ones for each of them."""

from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import replace
import re
from typing import Any

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.field import Field
from cloth_sim_ros.sim.scene_fields import SCENE_FIELDS

NAMES = 'colliders.names'
MOST_COLLIDERS = 32
# How many lengths each shape has, and which.
SHAPES = {
    'plane': '', 'sphere': 'radius', 'capsule': 'radius, length between its ends',
    'box': 'side along x, y and z', 'cylinder': 'radius, length'}
NAME_PATTERN = re.compile(r'[a-z][a-z0-9_]{0,39}')

# NAME stands for each of colliders.names.
COLLIDER_FIELDS = (
    Field('colliders.NAME.shape', str, 'sphere', 'shape; a plane is its z = 0 and keeps the cloth '
          'above, capsules and cylinders have their axis along z', choices=tuple(SHAPES)),
    Field('colliders.NAME.size', float, (), 'sphere: radius; capsule: radius, length of its axis; '
          'cylinder: radius, length; box: side lengths; plane: none', 'm', low=1e-4, high=1e5,
          is_array=True),
    Field('colliders.NAME.position', float, (0.0, 0.0, 0.0), 'centre, x y z', 'm',
          low=-1e5, high=1e5, is_array=True),
    Field('colliders.NAME.orientation', float, (0.0, 0.0, 0.0, 1.0), 'rotation as a quaternion '
          'x y z w of any length but 0', low=-1e3, high=1e3, is_array=True),
    Field('colliders.NAME.friction', float, 0.3, 'coefficient of Coulomb friction, static and '
          'sliding', low=0.0, high=1e3),
)


def fields_with_colliders(
        given: Mapping[str, Any], fields: tuple[Field, ...] = SCENE_FIELDS) -> tuple[Field, ...]:
    """
    Return ``fields`` and those of each collider that ``given`` names.

    Names that are wrong have none: ``check_names`` says what is wrong with them.
    """
    names = given.get(NAMES)
    if isinstance(names, str) or not isinstance(names, Sequence):
        return fields
    some = dict.fromkeys(name for name in names[:MOST_COLLIDERS] if _is_name(name))
    return fields + tuple(
        replace(field, name=field.name.replace('NAME', name))
        for name in some for field in COLLIDER_FIELDS)


def check_names(names: Sequence[str]) -> None:
    """Raise ClothSimError unless each of ``names`` can be that of a collider, and no two agree."""
    if len(names) > MOST_COLLIDERS:
        raise ClothSimError(
            f'{NAMES} has {len(names)} entries: give at most {MOST_COLLIDERS} colliders')
    for name in names:
        if not _is_name(name):
            raise ClothSimError(
                f'{NAMES} has {shown(name)}: give lower-case letters, digits and underscores, '
                'beginning with a letter, 40 at most')
    if len(set(names)) < len(names):
        raise ClothSimError(f'{NAMES} has a name twice: give each collider its own')


def _is_name(name: Any) -> bool:
    return isinstance(name, str) and name != 'names' and bool(NAME_PATTERN.fullmatch(name))
