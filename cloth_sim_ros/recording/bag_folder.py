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

"""The fresh folder of a recording."""

from datetime import datetime
from itertools import count
import os
from pathlib import Path

from cloth_sim_ros.sim.errors import ClothSimError

MOST_BYTES = 248  # file systems take 255, and the file's name is longer by _0.mcap


# The parameter that says where a node records into.
DIRECTORY_SETTING = 'recording.directory'


def make_bag_folder(
        directory: str | os.PathLike[str], name: str = '',
        setting: str = DIRECTORY_SETTING) -> Path:
    """
    Make a folder inside ``directory`` that was not there before, and return it.

    :param directory: is made as well when it is missing; ~ is the home folder
    :param name: of the folder; empty for one made of the date and the time
    :param setting: what ``directory`` was given by, for the error
    :raises ClothSimError: when the name would leave ``directory`` or is taken, or nothing can be
        written there
    """
    parent = Path(directory).expanduser().absolute()
    if name:
        _check_name(name, parent)
    try:
        parent.mkdir(parents=True, exist_ok=True)
        return _make_named(parent / name) if name else _make_dated(parent)
    except OSError as error:
        raise ClothSimError(
            f'nothing can be recorded into {parent} ({error.strerror}): '
            f'set {setting} to a folder that can be written to') from error


def _check_name(name: str, parent: Path) -> None:
    # One plain name can't lead anywhere else; control characters and half characters aren't plain.
    is_plain = name.isprintable() and '/' not in name and name not in ('.', '..')
    if not is_plain or len(name.encode()) > MOST_BYTES:
        raise ClothSimError(
            f'the recording name {name!r} is not the plain name of a folder inside {parent}: '
            f'give one without /, .. and control characters, up to {MOST_BYTES} bytes')


def _make_named(folder: Path) -> Path:
    try:
        folder.mkdir()
    except FileExistsError as error:
        raise ClothSimError(
            f'{folder} is there already, and no recording is overwritten: '
            'give another name, or none') from error
    return folder


def _make_dated(parent: Path) -> Path:
    stem = datetime.now().strftime('cloth_%Y_%m_%d-%H_%M_%S')
    for number in count():
        folder = parent / (f'{stem}_{number}' if number else stem)
        try:
            folder.mkdir()
        except FileExistsError:
            continue
        return folder
