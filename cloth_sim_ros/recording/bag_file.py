# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One mcap file as rosbag2 writes it."""

import io
import os
from pathlib import Path

from cloth_sim_ros.recording.bag_channel import BagChannel
from cloth_sim_ros.recording.mcap_size import McapSize
from cloth_sim_ros.recording.watched_file import WatchedFile
from mcap.writer import CompressionType
from mcap.writer import Writer

CHUNK_BYTES = 1024 * 1024
# Of a metadata record, besides its text.
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
