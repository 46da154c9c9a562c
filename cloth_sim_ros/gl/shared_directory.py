# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where files that come with the code lie: in the source tree, or in an installed share folder."""

from functools import cache
from pathlib import Path

from cloth_sim_ros.gl.errors import MissingFilesError

_INSTALLED = Path('share', 'cloth_sim_ros')


@cache
def shared_directory(name: str) -> Path:
    """
    Return the folder ``name`` that belongs to this code.

    :raises MissingFilesError: when there is none
    """
    here = Path(__file__).resolve()
    in_source = here.parents[2] / name
    if in_source.is_dir():
        return in_source
    for parent in here.parents:
        if (parent / _INSTALLED / name).is_dir():
            return parent / _INSTALLED / name
    raise MissingFilesError(
        f'there are no {name} beside {here.parents[1]}: reinstall the package, which contains '
        'them')


def shader_directory() -> Path:
    """Return the folder of the shaders that belong to this code."""
    return shared_directory('shaders')
