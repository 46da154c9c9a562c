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

"""A name that is not taken yet."""

from itertools import count
from pathlib import Path


def fresh_name(directory: str | Path, name: str) -> str:
    """Return ``name`` or, where it is taken in ``directory``, ``name`` with a number."""
    folder = Path(directory).expanduser()
    return next(
        candidate for candidate in (f'{name}_{number}' if number else name for number in count())
        if not (folder / candidate).exists())
