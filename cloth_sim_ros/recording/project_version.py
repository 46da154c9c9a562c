# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The version of this project, as recordings and the results of studies name it."""

from functools import cache
from importlib.metadata import PackageNotFoundError
from importlib.metadata import version

PACKAGE = 'cloth_sim_ros'


@cache
def project_version() -> str:
    """Return the version of the installed package; empty where it is not installed."""
    try:
        return version(PACKAGE)
    except PackageNotFoundError:
        return ''
