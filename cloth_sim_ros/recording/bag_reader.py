# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Any bag, opened: this project's, those of `ros2 bag record`, whole or broken."""

from collections.abc import Collection
from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.regular_file import is_folder
from cloth_sim_ros.files.regular_file import is_regular
from cloth_sim_ros.recording.bag_messages import BagTopic
from cloth_sim_ros.recording.bag_messages import MessageDecoder
from cloth_sim_ros.recording.bag_messages import RawMessage
from cloth_sim_ros.recording.bag_metadata import folder_metadata
from cloth_sim_ros.recording.bag_metadata import FRESH_METADATA_NAME
from cloth_sim_ros.recording.bag_metadata import METADATA_NAME
from cloth_sim_ros.recording.broken_mcap import BrokenMcap
from cloth_sim_ros.recording.decompression import decompress_file
from cloth_sim_ros.recording.decompression import decompress_message
from cloth_sim_ros.recording.indexed_mcap import IndexedMcap
from cloth_sim_ros.recording.recording_faults import nothing_flushed
from cloth_sim_ros.recording.sqlite_bag import SqliteBag
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


Storage = IndexedMcap | SqliteBag | BrokenMcap


class BagReader:
    """
    The messages of a bag, one in memory at a time.

    Reads a folder with mcap or sqlite3 files, with or without its metadata.yaml, or one such
    file. An mcap file that was cut off is read up to its last whole record. Messages can be
    walked through as often as wanted, also by several at a time.

    :raises ClothSimError: when there is nothing that can be read
    """

    def __init__(self, path: str | Path) -> None:
        """Open the files."""
        self.path = Path(path)
        self._decompressed: TemporaryDirectory[str] | None = None
        self._compression = compression_of(self.path) if is_folder(self.path) else 'none'
        self._unread: list[str] = []
        self._storages: list[Storage] = self._open()

    @property
    def problems(self) -> list[str]:
        """Get what could not be read, one sentence each; complete after messages() has ended."""
        found = [storage.problem for storage in self._storages if storage.problem]
        return self._unread + found

    @cached_property
    def topics(self) -> list[BagTopic]:
        """Get the topics, those of several files together; one name may have several types."""
        merged: dict[tuple[str, str], BagTopic] = {}
        for storage in self._storages:
            for topic in storage.topics:
                key = topic.name, topic.type_name
                known = merged.get(key)
                merged[key] = topic if known is None else replace(
                    known, count=known.count + topic.count, qos=known.qos or topic.qos)
        return list(merged.values())

    @cached_property
    def span(self) -> tuple[int, int]:
        """Get the times of the first and the last message [ns]; ClothSimError without one."""
        spans = [storage.span for storage in self._storages if storage.span is not None]
        if not spans:
            raise self.no_message()
        return min(begin for begin, _ in spans), max(end for _, end in spans)

    def no_message(self) -> ClothSimError:
        """Return the error of a bag that has none."""
        if not self.problems:
            return ClothSimError(f'{self.path} contains no messages: give another recording')
        return nothing_flushed(self.path, 'holds no message')

    def messages(
            self, names: Collection[str] | None = None, *, begin: int | None = None,
            end: int | None = None) -> Iterator[RawMessage]:
        """
        Yield the messages of the topics ``names``, or of all, from first to last.

        :param begin: time of the first one [ns]; None for the first of all
        :param end: time before which the last one was recorded [ns]; None for the last of all
        """
        for storage in self._storages:
            for message in storage.messages(names, begin, end):
                yield self._plain(message) if self._compression == 'message' else message

    def decode(self, message: RawMessage) -> Any:
        """Return the decoded message; ClothSimError when it can't be."""
        return self._decoder.decode(message)

    def prepare_check(self, type_name: str) -> None:
        """Do what the first ``problem_of`` a message of this type would take its time for."""
        self._decoder.check_of(type_name)

    def problem_of(self, message: RawMessage) -> str:
        """Return what is wrong with the lengths within a message; empty for nothing."""
        return self._decoder.problem(message)

    @cached_property
    def _decoder(self) -> MessageDecoder:
        return MessageDecoder(self.topics)

    def _open(self) -> list['Storage']:
        opened = []
        errors = []
        for file in self._files():
            try:
                opened.append(_storage(file))
            except ClothSimError as error:
                errors.append(error)
        if not opened:
            raise errors[0]
        self._unread = [str(error) for error in errors]
        self._unread += [
            f'{name} of {self.path} is missing: the other files are read'
            for name in missing_files(self.path)]
        return opened

    def _files(self) -> list[Path]:
        if self._compression != 'file':
            return storage_files(self.path)
        # It lives as long as this reader: each walk opens the files again.
        self._decompressed = TemporaryDirectory()
        found = []
        for number, file in enumerate(compressed_files(self.path)):
            found.append(Path(self._decompressed.name) / f'{number}_{file.stem}')
            try:
                decompress_file(file, found[-1])
            except Exception as error:  # of the disk, and of the decompressor
                raise self._undecompressed(error) from error
        return found

    def _plain(self, message: RawMessage) -> RawMessage:
        try:
            return message._replace(data=decompress_message(message.data))
        except Exception as error:  # a damaged byte can raise anything
            raise self._undecompressed(error) from error

    def _undecompressed(self, error: Exception) -> ClothSimError:
        return ClothSimError(
            f'{cut(self.path)} cannot be read ({cut(error) or type(error).__name__}): decompress '
            'it, or record it again')


def _storage(file: Path) -> Storage:
    if file.suffix == '.mcap':
        try:
            storage = IndexedMcap(file)
        except Exception:  # a broken file can raise anything
            return BrokenMcap(file)
        # The index of an mcap file may leave the topics out: they are found on the way.
        return storage if storage.topics else BrokenMcap(file)
    try:
        return SqliteBag(file)
    except Exception as error:  # a broken file can raise anything
        raise ClothSimError(
            f'{cut(file)} is not an intact sqlite3 bag ({cut(error) or type(error).__name__}): '
            f'give another one, or recover what is left with `sqlite3 {cut(file.name)} .recover | '
            'sqlite3 whole.db3`') from error
