# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Names of the colliders and cameras of a scene, by which their parameters are grouped."""

from collections.abc import Sequence
from dataclasses import replace
import re
from typing import Any

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.scene_fields import Field

NAME_PATTERN = re.compile(r'[a-z][a-z0-9_]{0,39}')


def is_name(name: Any) -> bool:
    """Return whether ``name`` can be that of a collider or a camera."""
    return isinstance(name, str) and name != 'names' and bool(NAME_PATTERN.fullmatch(name))


def fields_of_names(names: Any, most: int, fields: tuple[Field, ...]) -> tuple[Field, ...]:
    """
    Return ``fields`` for each of the first ``most`` ``names``; names that are wrong have none.

    :param names: as they are given, or None
    :param fields: with NAME in the place of the name
    """
    if isinstance(names, str) or not isinstance(names, Sequence):
        return ()
    some = dict.fromkeys(name for name in names[:most] if is_name(name))
    return tuple(
        replace(field, name=field.name.replace('NAME', name)) for name in some for field in fields)


def check_names(names: Sequence[str], parameter: str, kind: str, most: int) -> None:
    """
    Raise ClothSimError unless each of ``names`` can be that of a ``kind``, and no two agree.

    :param parameter: that lists them
    :param most: how many there may be
    """
    if len(names) > most:
        raise ClothSimError(
            f'{parameter} has {len(names)} entries: give at most {most} {kind}s')
    for name in names:
        if not is_name(name):
            raise ClothSimError(
                f'{parameter} has {shown(name)}: give lower-case letters, digits and underscores, '
                'beginning with a letter, 40 at most')
    if len(set(names)) < len(names):
        raise ClothSimError(f'{parameter} has a name twice: give each {kind} its own')
