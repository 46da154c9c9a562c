# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How a recording is laid out on the disk: its fresh folder, its files and their limits."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from itertools import count
import os
from pathlib import Path
import re
from typing import Any

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.recording.bag_metadata import FRESH_METADATA_NAME
from cloth_sim_ros.recording.bag_metadata import METADATA_NAME
from cloth_sim_ros.recording.recording_faults import refusal
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NameTakenError

MAX_SIZE_SETTING = 'recording.max_size'


@dataclass(frozen=True)
class RecordingOptions:
    """
    The options of a recording; the first two are those of rosbag2.

    :param max_bagfile_size: of one file, before the next one is begun [bytes]; 0 for no limit
    :param max_bagfile_duration: recorded time of one file [s]; 0 for no limit
    :param max_size: of all files of the recording, which is completed there [bytes]; 0 for none
    :param fsync: True to wait for the disk at each flush, not only at the end
    :param markers: True to record the markers too, for viewers that draw what is in a bag
    :param cameras: names of the cameras whose pictures are recorded
    """

    max_bagfile_size: int = 0
    max_bagfile_duration: float = 0.0
    max_size: int = 0
    fsync: bool = False
    markers: bool = False
    cameras: tuple[str, ...] = ()

    @classmethod
    def from_values(cls, values: Mapping[str, Any]) -> 'RecordingOptions':
        """Return the options that the parameters of a scene and a node, by name, ask for."""
        return cls(
            max_bagfile_size=values['recording.max_bagfile_size'],
            max_bagfile_duration=values['recording.max_bagfile_duration'],
            max_size=values[MAX_SIZE_SETTING],
            fsync=values['recording.fsync'],
            markers=values['recording.markers'],
            cameras=tuple(values['cameras.names']) if values['recording.cameras'] else ())

    @property
    def splits(self) -> bool:
        """Return whether the recording can have several files."""
        return self.max_bagfile_size > 0 or self.max_bagfile_duration > 0.0


# The fresh folder of a recording.

MOST_BYTES = 243  # file systems take 255, and a file's name is longer, as by _99999.mcap
# Letters and digits of any script; none of it means anything to a shell where it stands.
_PLAIN = re.compile(r'\w[\w.+\-=,@]*')

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
        raise refusal(parent, error, setting) from error


def fresh_name(directory: str | os.PathLike[str], name: str) -> str:
    """Return ``name`` or, where it is taken in ``directory``, ``name`` with a number."""
    folder = Path(directory).expanduser()
    return next(
        candidate for candidate in (f'{name}_{number}' if number else name for number in count())
        if not os.path.lexists(folder / candidate))


def sync_file(path: Path) -> None:
    """Wait until the disk has the file ``path``; one that is gone needs no disk."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOFOLLOW)
    except FileNotFoundError:
        return
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def sync_folder(folder: Path) -> None:
    """Wait until the disk has the names of the files in ``folder``."""
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def remove_bag_folder(folder: Path, file_count: int = 1) -> None:
    """Remove ``folder`` with up to ``file_count`` files of a bag, as far as that works."""
    files = [f'{folder.name}_{number}.mcap' for number in range(file_count)]
    try:
        # By their names: a folder can't be listed where no file can be opened any more.
        for name in (*files, METADATA_NAME, FRESH_METADATA_NAME):
            (folder / name).unlink(missing_ok=True)
        folder.rmdir()
    except OSError:
        pass


def _check_name(name: str, parent: Path) -> None:
    # A plain name leads nowhere else, is no option of a command and no pattern of a shell.
    if not _PLAIN.fullmatch(name) or len(name.encode()) > MOST_BYTES:
        raise ClothSimError(
            f'the recording name {shown(name)} is not the plain name of a folder inside '
            f'{cut(parent)}: start it with a letter, a digit or _, continue with these and '
            f'.+-=,@, and use up to {MOST_BYTES} bytes')


def _make_named(folder: Path) -> Path:
    try:
        folder.mkdir()
    except FileExistsError as error:
        raise NameTakenError(
            f'{folder} already exists, and no recording is overwritten: give another name, or '
            'none') from error
    return folder


def _make_dated(parent: Path) -> Path:
    stem = datetime.now().strftime('cloth_%Y_%m_%d-%H_%M_%S')
    folder = parent / stem
    number = 0
    while True:
        try:
            folder.mkdir()
        except FileExistsError:
            number += 1
            folder = parent / f'{stem}_{number}'
            continue
        return folder
