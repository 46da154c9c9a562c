# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The error of a recording that was cut off before anything of it was on the disk."""

from pathlib import Path

from cloth_sim_ros.sim.errors import ClothSimError


def nothing_flushed(path: Path, finding: str) -> ClothSimError:
    """
    Return the error of the bag or file ``path``.

    :param finding: what is there in place of a recording, behind the path
    """
    return ClothSimError(
        f'{path} {finding}, as it was truncated before the first flush, within a second of its '
        'start: give another recording, or read it later if it is being recorded')
