# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A bag as rosbag2 writes it: one mcap file or several, with their metadata.yaml."""

import io
import os
from pathlib import Path

from cloth_sim_ros.recording.bag_folder import MAX_SIZE_SETTING
from cloth_sim_ros.recording.bag_folder import RecordingOptions
from cloth_sim_ros.recording.bag_folder import sync_file
from cloth_sim_ros.recording.bag_folder import sync_folder
from cloth_sim_ros.recording.bag_metadata import BagChannel
from cloth_sim_ros.recording.bag_metadata import BagMetadata
from cloth_sim_ros.recording.bag_metadata import PACKAGE
from cloth_sim_ros.recording.bag_metadata import project_version
from cloth_sim_ros.recording.recording_faults import RecordingFull
from cloth_sim_ros.recording.recording_faults import WatchedFile
from mcap.writer import CompressionType
from mcap.writer import Writer

# Size of the records of the format, with opcode and length [bytes].
_MESSAGE = 31            # without its data
_MESSAGE_INDEX = 15      # of a channel in a chunk
_MESSAGE_INDEX_ENTRY = 16
_CHUNK = 60              # without what is in it
_CHUNK_INDEX = 100
_CHUNK_INDEX_ENTRY = 10  # of a channel
_STATISTICS_ENTRY = 10   # of a channel
# Statistics, offsets, the end of data, the footer and the last magic, with room to spare.
_END = 1024


class McapSize:
    """
    A bound of the finished length of a file that is being written.

    It counts the current chunk as if it could not be compressed, and the index at the end.
    """

    def __init__(self) -> None:
        """Begin with an empty file."""
        self._position = 0
        self._channels = 0
        self._chunk = 0       # records in the current chunk, and their index
        self._summary = _END

    def add_channel(self, length: int) -> None:
        """Count a channel whose name, type, definition and metadata have ``length`` bytes."""
        self._channels += 1
        # It stands in the data and again in the summary.
        self._chunk += length + _MESSAGE_INDEX
        self._summary += length + _STATISTICS_ENTRY

    def add_message(self, length: int) -> None:
        """Count a message of ``length`` bytes."""
        self._chunk += length + _MESSAGE + _MESSAGE_INDEX_ENTRY

    def set_position(self, position: int) -> None:
        """Note that the file has ``position`` bytes; where it has grown, a chunk was finished."""
        if position != self._position:
            self._position = position
            self._chunk = self._channels * _MESSAGE_INDEX
            self._summary += _CHUNK_INDEX + self._channels * _CHUNK_INDEX_ENTRY

    def bound(self, more: int = 0) -> int:
        """Return a length that the finished file does not pass, with ``more`` bytes of data."""
        chunk = self._chunk + more + _MESSAGE + _MESSAGE_INDEX_ENTRY
        # The bound that zstd gives for data that can't be compressed.
        compressed = chunk + chunk // 256 + 64 + _CHUNK
        next_index = _CHUNK_INDEX + self._channels * _CHUNK_INDEX_ENTRY
        return self._position + compressed + next_index + self._summary


# One mcap file as rosbag2 writes it.

CHUNK_BYTES = 1024 * 1024
# Upper bound of the size of a metadata record without its text [bytes].
_METADATA_BYTES = 128


class BagFile:
    """
    Writes messages into a fresh file; used from one thread.

    After each flush, all before it is readable whatever happens to the process.

    :param path: of the file
    :param metadata: text of the metadata record
    :param fsync: True to wait for the disk at each flush
    :raises OSError: when it can't be made
    """

    def __init__(self, path: Path, metadata: str, *, fsync: bool = False) -> None:
        """Open the file."""
        self._fsync = fsync
        self._numbers: dict[tuple[str, str], int] = {}
        self._schemas: dict[tuple[str, str, bytes], int] = {}
        self._size = McapSize()
        self._kept_bytes = 0
        self._raw = WatchedFile(path)
        self._stream = io.BufferedWriter(self._raw)
        try:
            self._writer = Writer(
                self._stream, chunk_size=CHUNK_BYTES, compression=CompressionType.ZSTD)
            self._writer.start(profile='ros2')
            self._add_metadata(metadata)
            self.flush()
        except Exception:
            self.abandon()
            raise

    @property
    def length(self) -> int:
        """Get the length of what is in the file [bytes]."""
        return self._raw.written

    def bound(self, channel: BagChannel, length: int, metadata_length: int) -> int:
        """
        Return a size that the finished file does not pass after one more message [bytes].

        :param length: of the message [bytes]
        :param metadata_length: of the metadata record at the end [bytes]
        """
        more = length + metadata_length + _METADATA_BYTES
        if channel.key not in self._numbers:
            more += 2 * channel.length
        return self._size.bound(more)

    def add_channel(self, channel: BagChannel) -> None:
        """Write what ``channel`` is, if that is not in the file yet."""
        if channel.key in self._numbers:
            return
        schema = channel.type_name, channel.definition_encoding, channel.definition
        if schema not in self._schemas:
            self._schemas[schema] = self._writer.register_schema(*schema)
        self._numbers[channel.key] = self._writer.register_channel(
            channel.name, channel.message_encoding, self._schemas[schema], dict(channel.metadata))
        self._size.add_channel(channel.length)
        self._size.set_position(self._stream.tell())

    def write(
            self, channel: BagChannel, data: bytes, time: int, *, published: int | None = None,
            sequence: int = 0) -> None:
        """
        Write the serialised message ``data``.

        :param time: at which it was recorded [ns]
        :param published: time at which it was published [ns]; None for ``time``
        """
        self.add_channel(channel)
        self._writer.add_message(
            self._numbers[channel.key], time, data, time if published is None else published,
            sequence)
        self._size.add_message(len(data))
        self._size.set_position(self._stream.tell())

    def flush(self) -> None:
        """Hand everything so far to the operating system, in whole records."""
        self._writer.flush()
        if self._fsync:
            os.fsync(self._raw.fileno())
        self._raw.check()
        self._kept_bytes = self._raw.written
        self._size.set_position(self._stream.tell())

    def finish(self, metadata: str, *, fsync: bool) -> None:
        """Write the index, and close the file; with ``fsync`` when all of it is on the disk."""
        self._writer.flush()
        self._add_metadata(metadata)
        self._writer.finish()
        self._stream.flush()
        if fsync:
            os.fsync(self._raw.fileno())
        self._raw.check()
        self._kept_bytes = self._raw.written
        self._stream.close()

    def abandon(self) -> None:
        """Close the file after a failed write, and cut off what came after the last flush."""
        if self._stream.closed:
            return
        try:
            self._raw.give_up(self._kept_bytes)
        finally:
            self._stream.close()

    def _add_metadata(self, text: str) -> None:
        self._writer.add_metadata('rosbag2', {'serialized_metadata': text})


_NANOSECONDS = 1e9
# Spare size of metadata for numbers that grow, per file and in total [bytes].
_MORE_DIGITS = 512
_EMPTY_FILE = 4096


class BagWriter:
    """
    Writes messages into ``folder``; used from one thread.

    Each file of a split bag is whole by itself: it has the definitions of all topics so far, and
    begins with the last message of each topic that late subscribers get one of.

    :param folder: empty, the bag takes its name
    :raises OSError: when no file can be made in it
    """

    def __init__(self, folder: Path, options: RecordingOptions = RecordingOptions()) -> None:
        """Open the first file."""
        self._folder = folder
        self._options = options
        self._channels: dict[tuple[str, str], BagChannel] = {}
        self._kept: dict[tuple[str, str], bytes] = {}
        self._finished_bytes = 0
        self._file_count = 1
        self._own_messages = 0  # of the present file, without those of an earlier one
        self._begin = 0         # of the present file [ns]
        self._end = 0           # of the bag so far [ns]
        self._metadata = BagMetadata(self._path.name, {PACKAGE: project_version()})
        self._measure_metadata()
        self._file = self._open()
        try:
            self._write_metadata()
        except Exception:
            self.abandon()
            raise

    def write(self, channel: BagChannel, data: bytes, time: int) -> None:
        """
        Write the serialised message ``data`` at ``time`` [ns].

        :raises RecordingFull: when that could take the bag beyond its size; nothing is written
        :raises OSError: when the next file can't be made, or this one not be written
        """
        self._check_room(channel, len(data))
        if self._own_messages and self._is_full(channel, len(data), time):
            self._split(time)
        if not self._own_messages:
            self._begin = time
        self._put(channel, data, time)
        self._own_messages += 1
        if self._options.splits and channel.transient_local:
            self._kept[channel.key] = data

    def flush(self) -> None:
        """Hand everything so far to the operating system, in whole records."""
        self._file.flush()
        self._write_metadata()

    def finish(self) -> None:
        """Complete the bag, and wait until the disk has it."""
        self._file.finish(self._metadata.text(), fsync=True)
        self._metadata.write(self._folder, fsync=True)
        for number in range(self._file_count - 1):
            sync_file(self._file_path(number))
        sync_folder(self._folder)
        sync_folder(self._folder.parent)

    def abandon(self) -> None:
        """Close the file after a failed write, and cut off what came after the last flush."""
        self._file.abandon()

    @property
    def _path(self) -> Path:
        return self._file_path(self._file_count - 1)

    def _file_path(self, number: int) -> Path:
        return self._folder / f'{self._folder.name}_{number}.mcap'

    def _write_metadata(self) -> None:
        self._metadata.write(self._folder, fsync=self._options.fsync)

    def _open(self) -> BagFile:
        return BagFile(self._path, self._metadata.text(), fsync=self._options.fsync)

    def _put(self, channel: BagChannel, data: bytes, time: int) -> None:
        if channel.key not in self._channels:
            self._channels[channel.key] = channel
            self._metadata.add_topic(channel)
            self._measure_metadata()
        self._file.write(channel, data, time)
        self._metadata.add_message(channel, time)
        self._end = max(self._end, time)

    def _split(self, time: int) -> None:
        # The disk is not waited for: what comes meanwhile would be lost in a crash.
        self._file.finish(self._metadata.text(), fsync=self._options.fsync)
        self._finished_bytes += self._file.length
        self._file_count += 1
        self._metadata.begin_file(self._path.name)
        self._measure_metadata()
        self._file = self._open()
        self._own_messages = 0
        for channel in self._channels.values():
            self._file.add_channel(channel)
        for key, data in self._kept.items():
            self._put(self._channels[key], data, time)
        self.flush()

    def _is_full(self, channel: BagChannel, length: int, time: int) -> bool:
        options = self._options
        if options.max_bagfile_duration > 0.0:
            if time - self._begin >= options.max_bagfile_duration * _NANOSECONDS:
                return True
        return 0 < options.max_bagfile_size < self._file.bound(
            channel, length, self._metadata_bytes)

    def _check_room(self, channel: BagChannel, length: int) -> None:
        most = self._options.max_size
        if not most:
            return
        # metadata.yaml stands there twice while it is being written.
        bound = self._finished_bytes + 2 * self._metadata_bytes + self._file.bound(
            channel, length, self._metadata_bytes)
        if self._options.splits:
            bound += self._repeated_bytes() + self._metadata_bytes
        if bound > most:
            raise RecordingFull(
                f'the recording {self._folder} is complete up to {self._end / _NANOSECONDS:.6g} s '
                f'of recorded time, as more could exceed {MAX_SIZE_SETTING} {most} bytes: set a '
                'larger limit, and start a new recording')

    def _repeated_bytes(self) -> int:
        """Return what the next file would have of this one [bytes]."""
        definitions = sum(channel.length for channel in self._channels.values())
        return _EMPTY_FILE + 2 * definitions + sum(map(len, self._kept.values()))

    def _measure_metadata(self) -> None:
        self._metadata_bytes = len(self._metadata.text()) + _MORE_DIGITS * (1 + self._file_count)
