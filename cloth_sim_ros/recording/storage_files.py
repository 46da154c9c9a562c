# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The files a bag is made of."""

from pathlib import Path

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.regular_file import is_folder
from cloth_sim_ros.files.regular_file import is_regular
from cloth_sim_ros.recording.bag_metadata import folder_metadata
from cloth_sim_ros.recording.bag_metadata import FRESH_METADATA_NAME
from cloth_sim_ros.recording.bag_metadata import METADATA_NAME
from cloth_sim_ros.recording.recording_faults import nothing_flushed
from cloth_sim_ros.sim.errors import ClothSimError

SUFFIXES = ('.mcap', '.db3')


def storage_files(path: Path) -> list[Path]:
    """
    Return the files of the bag ``path``, a folder or a file, from first to last.

    :raises ClothSimError: when there is none
    """
    if is_regular(path):
        if path.suffix not in SUFFIXES:
            raise ClothSimError(
                f'{cut(path)} is neither an .mcap nor a .db3 file: give the folder of a '
                'recording')
        return [path]
    if not is_folder(path):
        raise ClothSimError(
            f'there is no recording {cut(path)}: give its folder, its mcap or its db3 file')
    named = _named(path)
    if named and all(is_regular(file) and file.suffix in SUFFIXES for file in named):
        return named + _next_files(named[-1])
    for suffix in SUFFIXES:
        # rosbag2 numbers the files of a split recording without leading zeros.
        files = sorted(
            (file for file in path.glob(f'*{suffix}') if is_regular(file)),
            key=lambda file: (len(file.name), file.name))
        if files:
            return files
    if all(entry.name in (METADATA_NAME, FRESH_METADATA_NAME) for entry in path.iterdir()):
        raise nothing_flushed(path, 'is a folder without a file of messages')
    raise ClothSimError(
        f'{cut(path)} holds no mcap and no db3 file: give the folder of a recording')


def missing_files(path: Path) -> list[str]:
    """Return the names of files of the bag ``path`` that its metadata.yaml has and nobody else."""
    named = _named(path) if is_folder(path) else []
    missing = [file.name for file in named if not is_regular(file)]
    # Files that were given other names are there all the same.
    return missing if missing and len(storage_files(path)) < len(named) else []


def metadata_problem(path: Path) -> str:
    """Return what is wrong with the metadata.yaml of ``path``; empty where nothing is."""
    if not is_folder(path):
        return ''
    if not folder_metadata(path):
        return f'{METADATA_NAME} is missing or damaged'
    files = [file.name for file in storage_files(path)]
    if [file.name for file in _named(path)] != files:
        return f'{METADATA_NAME} does not name {", ".join(files)}'
    return ''


def compressed_files(path: Path) -> list[Path]:
    """
    Return the files of the folder ``path`` that rosbag2 compressed as a whole.

    :raises ClothSimError: when one of those that metadata.yaml names is not there
    """
    files = _named(path)
    missing = [file for file in files if not is_regular(file)]
    if missing or not files:
        name = cut(missing[0].name) if missing else 'that its metadata.yaml names'
        raise ClothSimError(f'{cut(path)} has no file {name}: give the whole folder')
    return files


def compression_of(folder: Path) -> str:
    """
    Return what rosbag2 compressed in the bag ``folder``: file, message, or none.

    :raises ClothSimError: when it did so in another way than by zstd
    """
    metadata = folder_metadata(folder)
    mode = cut(metadata.get('compression_mode') or 'none').lower()
    if mode not in ('file', 'message'):
        return 'none'
    kind = cut(metadata.get('compression_format'), 64)
    if kind != 'zstd':
        raise ClothSimError(
            f'{cut(folder)} is compressed by {kind}, and only zstd is read: decompress it')
    return mode


def _named(folder: Path) -> list[Path]:
    """Return the files that metadata.yaml names, each once."""
    names = folder_metadata(folder).get('relative_file_paths')
    names = names if isinstance(names, list) else []
    return list(dict.fromkeys(
        folder / Path(name).name for name in names if isinstance(name, str)))


def _next_files(last: Path) -> list[Path]:
    """Return files of a split bag behind ``last``: a cut can come before metadata.yaml has one."""
    stem, _, number = last.stem.rpartition('_')
    files = []
    while number.isdecimal() and len(number) < 9:
        number = str(int(number) + 1)
        file = last.with_name(f'{stem}_{number}{last.suffix}')
        if not is_regular(file):
            break
        files.append(file)
    return files
