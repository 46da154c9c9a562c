# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Make a whole bag from the readable rest of a damaged one."""

from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cloth_sim_ros.files.checked_yaml import parse_yaml
from cloth_sim_ros.files.regular_file import is_folder
from cloth_sim_ros.recording.bag_folder import make_bag_folder
from cloth_sim_ros.recording.bag_folder import remove_bag_folder
from cloth_sim_ros.recording.bag_folder import sync_folder
from cloth_sim_ros.recording.bag_messages import qos_profiles
from cloth_sim_ros.recording.bag_metadata import BagChannel
from cloth_sim_ros.recording.bag_metadata import BagMetadata
from cloth_sim_ros.recording.bag_reader import compression_of
from cloth_sim_ros.recording.bag_reader import metadata_problem
from cloth_sim_ros.recording.bag_reader import missing_files
from cloth_sim_ros.recording.bag_reader import storage_files
from cloth_sim_ros.recording.bag_writer import BagFile
from cloth_sim_ros.recording.broken_mcap import McapScan
from cloth_sim_ros.recording.indexed_mcap import IndexedMcap
from cloth_sim_ros.recording.recording_faults import nothing_flushed
from cloth_sim_ros.recording.recording_faults import refusal
from cloth_sim_ros.sim.errors import ClothSimError
from mcap.records import Channel
from mcap.records import Message
from mcap.records import Metadata
from mcap.records import Schema


@dataclass(frozen=True)
class _Contents:
    """Records of a file besides its messages, and the number of those."""

    path: Path
    channels: dict[int, BagChannel]
    custom_data: dict[str, str]
    message_count: int
    problems: list[str]


class Recovery:
    """
    Finds what is whole in a bag of mcap files, and writes it as a new bag.

    ``problems`` names what is missing of the bag, one sentence each. ``message_count`` is the
    number of the whole messages; ``begin`` and ``end`` are the times of the first and the last
    [ns].

    :param source: folder of the bag, or one mcap file
    :raises ClothSimError: when there is no message in it, or it is no bag of mcap files
    """

    def __init__(self, source: Path) -> None:
        """Read all files, and change nothing."""
        self.source = source
        if is_folder(source) and compression_of(source) != 'none':
            raise ClothSimError(
                f'{source} is compressed by rosbag2, and cannot be recovered in that form: '
                'decompress its files first')
        files = storage_files(source)
        if any(file.suffix != '.mcap' for file in files):
            raise ClothSimError(
                f'{source} has sqlite3 files, and only mcap files can be recovered: recover what '
                f'is left with `sqlite3 {files[0].name} .recover | sqlite3 whole.db3`')
        self._times: list[int] = []
        try:
            self._files = [self._read(file) for file in files]
        except OSError as error:
            raise ClothSimError(
                f'{error.filename} cannot be read ({error.strerror}): give a recording you may '
                'read') from error
        self.problems = [
            f'{contents.path.name} lacks {problem}' for contents in self._files
            for problem in contents.problems]
        self.problems += [f'{name} is missing' for name in missing_files(source)]
        if problem := metadata_problem(source):
            self.problems.append(problem)
        self.message_count = sum(contents.message_count for contents in self._files)
        if not self.message_count and self.problems:
            raise nothing_flushed(source, 'holds no message')
        self.begin, self.end = (min(self._times), max(self._times)) if self._times else (0, 0)

    def write(self, target: Path, setting: str) -> None:
        """
        Write all whole messages into the new folder ``target``, one file for each that has any.

        :param setting: what ``target`` was given by, for errors
        :raises ClothSimError: when ``target`` is there already, or cannot be written
        """
        folder = make_bag_folder(target.parent, target.name, setting)
        kept = [contents for contents in self._files if contents.message_count]
        names = [f'{folder.name}_{number}.mcap' for number in range(len(kept))]
        custom_data: dict[str, str] = {}
        for contents in kept:
            custom_data.update(contents.custom_data)
        metadata = BagMetadata(names[0], custom_data)
        try:
            for contents, name in zip(kept, names):
                metadata.begin_file(name)
                _copy(contents, folder / name, metadata)
            metadata.write(folder, fsync=True)
            sync_folder(folder)
        except OSError as error:
            remove_bag_folder(folder, len(kept))
            raise refusal(folder, error, setting) from error

    def _read(self, path: Path) -> _Contents:
        scan = McapScan(path)
        schemas: dict[int, Schema] = {}
        channels: dict[int, Channel] = {}
        custom_data: dict[str, str] = {}
        counts: Counter[int] = Counter()
        times: list[int] = []
        for record in scan.records():
            if isinstance(record, Schema):
                schemas[record.id] = record
            elif isinstance(record, Channel):
                channels[record.id] = record
            elif isinstance(record, Message):
                times = [min([*times[:1], record.log_time]), max([*times[1:], record.log_time])]
                counts[record.channel_id] += 1
            elif isinstance(record, Metadata):
                custom_data.update(_custom_data(record))
        problems = list(scan.problems)
        unknown = sum(count for number, count in counts.items() if number not in channels)
        if unknown:
            problems.append(f'the topics of {unknown} messages')
        if not problems and not _has_index(path):
            problems.append('its index')
        self._times += times
        return _Contents(
            path, {number: _bag_channel(channel, schemas.get(channel.schema_id))
                   for number, channel in channels.items()},
            custom_data, counts.total() - unknown, problems)


def _copy(contents: _Contents, path: Path, metadata: BagMetadata) -> None:
    file = BagFile(path, metadata.text())
    try:
        for record in McapScan(contents.path).records():
            if not isinstance(record, Message) or record.channel_id not in contents.channels:
                continue
            channel = contents.channels[record.channel_id]
            metadata.add_topic(channel)
            metadata.add_message(channel, record.log_time)
            file.write(
                channel, record.data, record.log_time, published=record.publish_time,
                sequence=record.sequence)
        file.finish(metadata.text(), fsync=True)
    except Exception:
        file.abandon()
        raise


def _has_index(path: Path) -> bool:
    try:
        IndexedMcap(path)
    except Exception:  # a damaged index can raise anything
        return False
    return True


def _bag_channel(channel: Channel, schema: Schema | None) -> BagChannel:
    return BagChannel(
        channel.topic, schema.name if schema else '', schema.encoding if schema else '',
        schema.data if schema else b'', channel.metadata,
        qos_profiles(channel.metadata.get('offered_qos_profiles', '')),
        channel.metadata.get('topic_type_hash', ''), message_encoding=channel.message_encoding)


def _custom_data(record: Metadata) -> dict[str, str]:
    """Return what a bag notes besides its topics, from its metadata record."""
    try:
        content: Any = parse_yaml(
            record.metadata['serialized_metadata'], 'the metadata of the bag')
        return {str(key): str(value) for key, value in content['custom_data'].items()}
    except (ClothSimError, KeyError, TypeError, AttributeError):
        return {}
