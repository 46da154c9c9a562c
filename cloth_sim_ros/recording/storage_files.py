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


"""The files a bag is made of."""

from pathlib import Path
from typing import Any

from cloth_sim_ros.sim.errors import ClothSimError
import yaml

SUFFIXES = ('.mcap', '.db3')
# Ten times as fast, where PyYAML was built with libyaml.
_LOADER = getattr(yaml, 'CSafeLoader', yaml.SafeLoader)


def storage_files(path: Path) -> list[Path]:
    """
    Return the files of the bag ``path``, a folder or a file, from first to last.

    :raises ClothSimError: when there is none
    """
    if path.is_file():
        if path.suffix not in SUFFIXES:
            raise ClothSimError(
                f'{path} is neither an .mcap nor a .db3 file: give the folder of a recording')
        return [path]
    if not path.is_dir():
        raise ClothSimError(
            f'there is no recording {path}: give its folder, its mcap or its db3 file')
    named = [path / Path(str(name)).name for name in _list(_metadata(path))]
    if named and all(file.is_file() and file.suffix in SUFFIXES for file in named):
        return named
    for suffix in SUFFIXES:
        # rosbag2 numbers the files of a split recording without leading zeros.
        files = sorted(path.glob(f'*{suffix}'), key=lambda file: (len(file.name), file.name))
        if files:
            return files
    raise ClothSimError(
        f'{path} holds no mcap and no db3 file: give the folder of a recording')


def is_compressed(folder: Path) -> bool:
    """Tell whether rosbag2 compressed whole files or single messages: metadata.yaml says how."""
    mode = str(_metadata(folder).get('compression_mode') or 'none').lower()
    return mode in ('file', 'message')


def _metadata(folder: Path) -> dict[str, Any]:
    """Return the content of metadata.yaml; empty when it is missing or broken."""
    try:
        content = yaml.load((folder / 'metadata.yaml').read_bytes(), _LOADER)
        information = content['rosbag2_bagfile_information']
        return information if isinstance(information, dict) else {}
    except (OSError, yaml.YAMLError, ValueError, KeyError, TypeError):
        return {}


def _list(metadata: dict[str, Any]) -> list[Any]:
    names = metadata.get('relative_file_paths')
    return names if isinstance(names, list) else []
