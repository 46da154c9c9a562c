# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
