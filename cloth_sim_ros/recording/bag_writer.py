# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A bag as rosbag2 writes it: one mcap file or several, with their metadata.yaml."""

from pathlib import Path

from cloth_sim_ros.recording.bag_channel import BagChannel
from cloth_sim_ros.recording.bag_file import BagFile
from cloth_sim_ros.recording.bag_folder import sync_file
from cloth_sim_ros.recording.bag_folder import sync_folder
from cloth_sim_ros.recording.bag_metadata import BagMetadata
from cloth_sim_ros.recording.project_version import PACKAGE
from cloth_sim_ros.recording.project_version import project_version
from cloth_sim_ros.recording.recording_faults import RecordingFull
from cloth_sim_ros.recording.recording_options import MAX_SIZE_SETTING
from cloth_sim_ros.recording.recording_options import RecordingOptions

_NANOSECONDS = 1e9
# What metadata can grow by as its numbers do, for each file and in all [bytes].
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
