# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where a ROS package keeps its files."""

from importlib.util import find_spec
from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from cloth_sim_ros.sim.errors import ClothSimError


def share_folder(package: str) -> Path:
    """Return the share/ folder of ``package``, from the ament index or beside its Python code."""
    try:
        return Path(get_package_share_directory(package))
    except KeyError:
        pass
    except OSError as error:
        # Without a sourced ROS the index has no search path at all: an OSError without a number.
        if error.errno is not None:
            raise
    code = find_spec(package)
    for prefix in Path(code.origin).parents if code is not None and code.origin else ():
        folder = prefix / 'share' / package
        if folder.is_dir():
            return folder
    raise ClothSimError(
        f'the ROS package {package} has no share folder, from which recordings take its message '
        'definitions: install or build it, and source its setup')
