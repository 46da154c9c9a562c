# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which version of this project has made a recording."""

from collections.abc import Mapping
from pathlib import Path

from cloth_sim_ros.recording.folder_metadata import folder_metadata
from cloth_sim_ros.recording.project_version import PACKAGE


def recorded_version(path: Path) -> str:
    """
    Return the version named in the metadata.yaml of the recording ``path``; empty without one.

    :param path: of its folder or of a file in it
    """
    folder = path if path.is_dir() else path.parent
    custom = folder_metadata(folder).get('custom_data')
    version = custom.get(PACKAGE) if isinstance(custom, Mapping) else None
    return version if isinstance(version, str) else ''
