# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the metadata.yaml of a bag holds."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cloth_sim_ros.files.checked_yaml import load_yaml
from cloth_sim_ros.sim.errors import ClothSimError

METADATA_NAME = 'metadata.yaml'
FRESH_METADATA_NAME = f'{METADATA_NAME}.new'  # while it is being written


def folder_metadata(folder: Path) -> Mapping[str, Any]:
    """
    Return what rosbag2 has written of the bag in ``folder``.

    It is empty when metadata.yaml is missing, broken or hostile: files tell the same.
    """
    try:
        content = load_yaml(folder / METADATA_NAME)
    except ClothSimError:
        return {}
    information = content.get('rosbag2_bagfile_information') if isinstance(
        content, Mapping) else None
    return information if isinstance(information, Mapping) else {}
