# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A name that is not taken yet."""

from itertools import count
from pathlib import Path


def fresh_name(directory: str | Path, name: str) -> str:
    """Return ``name`` or, where it is taken in ``directory``, ``name`` with a number."""
    folder = Path(directory).expanduser()
    return next(
        candidate for candidate in (f'{name}_{number}' if number else name for number in count())
        if not (folder / candidate).exists())
