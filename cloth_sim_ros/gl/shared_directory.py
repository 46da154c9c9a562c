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
