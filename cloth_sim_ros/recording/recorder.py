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

"""A recording under way."""

import os
from pathlib import Path
from queue import Empty
from queue import SimpleQueue
import threading
import time

from cloth_sim_ros.messages.stamp import nanoseconds
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.recording.bag_file import BagFile
from cloth_sim_ros.recording.bag_folder import DIRECTORY_SETTING
from cloth_sim_ros.recording.bag_folder import make_bag_folder
from cloth_sim_ros.recording.message_definition import message_definition
from cloth_sim_ros.recording.message_definition import type_hash
from cloth_sim_ros.recording.recording_error import RecordingError
from cloth_sim_ros.sim.errors import ClothSimError

FLUSH_PERIOD = 1.0     # wall time [s]
POLL = 2e-3            # of one thread for the other [s]
MOST_WAITING = 2**28   # bytes not yet written, before the simulation has to wait


class Recorder:
    """
    Records topics into a fresh bag.

    A thread of its own does the writing: a signal that interrupts the main thread anywhere can't
    leave half a record behind, and compressing does not hold the simulation up.

    :param directory: the bag's folder is made in here
    :param name: of that folder; empty for one made of the date and the time
    :param node_name: with its namespace, for the names of the topics
    :param setting: what ``directory`` was given by, for errors
    :raises ClothSimError: when the name leaves ``directory`` or is taken, or it can't be written
    """

    def __init__(
            self, directory: str | os.PathLike[str], name: str = '',
            node_name: str = 'cloth_sim', *, setting: str = DIRECTORY_SETTING) -> None:
        """Open the recording."""
        for topic in TOPICS.values():
            if topic.recorded:
                # Read now, and kept: what is missing is told before anything is recorded.
                message_definition(topic.type_name)
                type_hash(topic.type_name)
        self.path = make_bag_folder(directory, name, setting)
        self._setting = setting
        try:
            self._file = BagFile(self.path, node_name)
        except OSError as error:
            _remove(self.path)
            raise ClothSimError(self._reason(error)) from error
        self._queue: SimpleQueue = SimpleQueue()
        # Each is changed by one thread only, so that neither needs a lock.
        self._taken_bytes = 0
        self._written_bytes = 0
        self._closed = False
        self._error: RecordingError | None = None
        self._ended = False
        threading.Thread(target=self._work, name='recorder').start()

    def write(self, key: str, data: bytes, sim_time: float) -> None:
        """
        Record ``data``, a serialised message of the topic ``key``, at ``sim_time`` [s].

        What TOPICS does not record is left out, as is what comes after closing.

        :raises RecordingError: once, when the recording could not go on; after that, nothing is
            recorded
        """
        self._raise_error()
        topic = TOPICS[key]
        if self._closed or not topic.recorded:
            return
        while self._taken_bytes - self._written_bytes > MOST_WAITING and not self._ended:
            time.sleep(POLL)
        self._queue.put((topic, data, nanoseconds(sim_time)))
        self._taken_bytes += len(data)

    def close(self) -> None:
        """
        Complete the recording; does nothing when it is closed already.

        :raises RecordingError: when the end of it could not be written, if not told before
        :raises KeyboardInterrupt: when interrupted, but not before all is written
        """
        self._closed = True
        self._queue.put(None)
        interrupted = False
        # Not Thread.join: before Python 3.13 an interrupt in it takes the thread for ended.
        while not self._ended:
            try:
                time.sleep(POLL)
            except KeyboardInterrupt:
                interrupted = True
        if interrupted:
            raise KeyboardInterrupt
        self._raise_error()

    def _raise_error(self) -> None:
        error, self._error = self._error, None
        if error is not None:
            raise error

    def _work(self) -> None:
        try:
            while self._write_for(FLUSH_PERIOD):
                self._file.flush()
            self._file.finish()
        except Exception as error:
            self._closed = True
            self._give_up(error)
        finally:
            self._ended = True

    def _write_for(self, period: float) -> bool:
        """Write what comes within ``period`` [s]; return False when it was the last."""
        end = time.monotonic() + period
        while (left := end - time.monotonic()) > 0.0:
            try:
                entry = self._queue.get(timeout=left)
            except Empty:
                # A program that ends without closing still leaves a complete recording.
                return threading.main_thread().is_alive()
            if entry is None:
                return False
            self._file.write(*entry)
            self._written_bytes += len(entry[1])
        return True

    def _give_up(self, error: Exception) -> None:
        try:
            self._file.abandon()
        except OSError:
            pass  # then it ends in half a record, which readers of broken files skip
        self._error = RecordingError(self._reason(error))

    def _reason(self, error: Exception) -> str:
        reason = getattr(error, 'strerror', None) or error or type(error).__name__
        return (
            f'recording to {self.path} has ended ({reason}): make room, or set {self._setting} to '
            'another disk, and start a new one')


def _remove(folder: Path) -> None:
    """Remove what was begun in ``folder``, as far as that works."""
    try:
        for path in folder.iterdir():
            path.unlink()
        folder.rmdir()
    except OSError:
        pass
