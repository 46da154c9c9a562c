# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A recording in progress, and the topics of this project as they stand in it."""

from collections import Counter
from collections.abc import Callable
import os
from pathlib import Path
from queue import Empty
from queue import SimpleQueue
import threading
import time
from typing import Any

from cloth_sim_ros.messages.stamp import nanoseconds
from cloth_sim_ros.messages.topics import camera_topics
from cloth_sim_ros.messages.topics import RECORDED_PARTS
from cloth_sim_ros.messages.topics import Topic
from cloth_sim_ros.messages.topics import topic_of
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.recording.bag_folder import DIRECTORY_SETTING
from cloth_sim_ros.recording.bag_folder import make_bag_folder
from cloth_sim_ros.recording.bag_folder import RecordingOptions
from cloth_sim_ros.recording.bag_folder import remove_bag_folder
from cloth_sim_ros.recording.bag_metadata import BagChannel
from cloth_sim_ros.recording.bag_metadata import yaml_text
from cloth_sim_ros.recording.message_definition import message_definition
from cloth_sim_ros.recording.message_definition import type_hash
from cloth_sim_ros.recording.recording_faults import ending
from cloth_sim_ros.recording.recording_faults import RecordingError
from cloth_sim_ros.recording.recording_faults import RecordingFull
from cloth_sim_ros.recording.recording_faults import refusal
from cloth_sim_ros.recording.writer_choice import chosen_library
from cloth_sim_ros.recording.writer_choice import open_writer
from cloth_sim_ros.sim.errors import ClothSimError

_FOR_EVER = (9223372036, 854775807)  # RMW_DURATION_INFINITE


def offered_qos(topic: Topic) -> list[dict[str, Any]]:
    """Return the profile of the one publisher of ``topic``."""
    return [{
        'history': 'keep_last',
        'depth': topic.depth,
        'reliability': 'reliable' if topic.reliable else 'best_effort',
        'durability': 'transient_local' if topic.transient_local else 'volatile',
        'deadline': _for_ever(),
        'lifespan': _for_ever(),
        'liveliness': 'automatic',
        'liveliness_lease_duration': _for_ever(),
        'avoid_ros_namespace_conventions': False,
    }]


def _for_ever() -> dict[str, int]:
    # A new one each time: YAML would write references to a shared one.
    return {'sec': _FOR_EVER[0], 'nsec': _FOR_EVER[1]}


# A topic of this project as it stands in its recordings.


def topic_channel(topic: Topic, node_name: str) -> BagChannel:
    """
    Return ``topic`` of the node ``node_name``, which has its namespace.

    :raises ClothSimError: when the package of its type is missing
    :raises OSError: when the definition can't be read
    """
    qos = offered_qos(topic)
    announced = type_hash(topic.type_name)
    return BagChannel(
        topic.full_name(node_name), topic.type_name, 'ros2msg',
        message_definition(topic.type_name).encode(),
        {'offered_qos_profiles': yaml_text(qos), 'topic_type_hash': announced},
        qos, announced, topic.transient_local)


# A recording in progress.

# Wall time [s]. With what a flush takes, a process that is killed loses less than a second.
FLUSH_PERIOD = 0.5
GATHER = 0.05          # between two looks at what waits to be written
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
    :param options: files, limit and fsync
    :param on_end: called on another thread when the recording has ended before it was closed
    :param library: one of LIBRARIES that writes it; None for the one that would be chosen now
    :raises ModuleNotFoundError: when there is no library that writes it
    :raises ClothSimError: when the name leaves ``directory`` or is taken, or it can't be written
    """

    def __init__(
            self, directory: str | os.PathLike[str], name: str = '',
            node_name: str = 'cloth_sim', *, setting: str = DIRECTORY_SETTING,
            options: RecordingOptions = RecordingOptions(),
            on_end: Callable[[], None] | None = None, library: str | None = None) -> None:
        """Open the recording."""
        try:
            # Definitions are read now, so that a missing one is reported before a run.
            self._channels = {
                key: topic_channel(topic, node_name) for key, topic in TOPICS.items()
                if topic.recorded or (key == 'markers' and options.markers)}
            self._channels |= {
                key: topic_channel(topic, node_name)
                for key, topic in camera_topics(options.cameras, RECORDED_PARTS).items()}
        except OSError as error:
            raise refusal(Path(directory), error, setting) from error
        self.path = make_bag_folder(directory, name, setting)
        self._setting = setting
        self._on_end = on_end
        self._queue: SimpleQueue[tuple[BagChannel, bytes, int] | None] = SimpleQueue()
        # Each is changed by one thread only, so that neither needs a lock.
        self._taken_bytes = 0
        self._written_bytes = 0
        self._written: Counter[str] = Counter()  # messages by the name of their topic
        self._closed = False
        self._error: RecordingError | None = None
        self._ended = False
        try:
            self._bag = open_writer(
                chosen_library() if library is None else library, self.path, options)
            try:
                threading.Thread(target=self._work, name='recorder').start()
            except RuntimeError:
                self._bag.abandon()
                raise
        except (ClothSimError, ModuleNotFoundError):
            remove_bag_folder(self.path)
            raise
        except (OSError, RuntimeError) as error:
            remove_bag_folder(self.path)
            raise refusal(self.path, error, setting) from error

    def takes(self, key: str) -> bool:
        """Return whether messages of the topic ``key`` are recorded."""
        return topic_of(key).key in self._channels

    def write(self, key: str, data: bytes, sim_time: float, epoch: int = 0) -> None:
        """
        Record ``data``, a serialised message of the topic ``key``, at ``sim_time`` [s].

        What is not recorded is left out, as is what comes after closing.

        :param epoch: time of the recording at simulated time 0 [ns]
        :raises RecordingError: once, when the recording could not go on; after that, nothing is
            recorded
        """
        self.check()
        if self._closed or not self.takes(key):
            return
        while self._taken_bytes - self._written_bytes > MOST_WAITING and not self._ended:
            time.sleep(POLL)
        self._queue.put((self._channels[key], data, epoch + nanoseconds(sim_time)))
        self._taken_bytes += len(data)

    def written(self, key: str) -> int:
        """Return how many messages of the topic ``key`` have been written so far."""
        return self._written[self._channels[key].name]

    def check(self) -> None:
        """
        Make sure that the recording goes on.

        :raises RecordingError: as ``write`` does, once
        """
        error, self._error = self._error, None
        if error is not None:
            raise error

    def close(self) -> None:
        """
        Complete the recording; does nothing when it is closed already.

        :raises RecordingError: when the end of it could not be written, if not told before
        :raises KeyboardInterrupt: when interrupted, but not before all is written
        """
        self._closed = True
        self._queue.put(None)
        interrupted = False
        # Not Thread.join: before Python 3.13, after an interrupt in it the thread counts as ended.
        while not self._ended:
            try:
                time.sleep(POLL)
            except KeyboardInterrupt:
                interrupted = True
        if interrupted:
            raise KeyboardInterrupt
        self.check()

    def _work(self) -> None:
        try:
            self._record()
        except Exception as error:
            self._closed = True
            self._give_up(error)
        finally:
            self._ended = True
        if self._error is not None and self._on_end is not None:
            self._on_end()

    def _record(self) -> None:
        full = None
        try:
            while self._write_for(FLUSH_PERIOD):
                self._bag.flush()
        except RecordingFull as error:
            full = error
            self._closed = True
        self._bag.finish()
        self._error = full

    def _write_for(self, period: float) -> bool:
        """Write what comes within ``period`` [s]; return False when it was the last."""
        end = time.monotonic() + period
        while time.monotonic() < end:
            try:
                entry = self._queue.get_nowait()
            except Empty:
                # No wake-up per message: two threads that alternate slow each other down.
                time.sleep(GATHER)
                # A program that ends without closing still leaves a complete recording.
                if self._queue.empty() and not threading.main_thread().is_alive():
                    return False
                continue
            if entry is None:
                return False
            self._bag.write(*entry)
            self._written_bytes += len(entry[1])
            self._written[entry[0].name] += 1
        return True

    def _give_up(self, error: Exception) -> None:
        try:
            self._bag.abandon()
        except OSError:
            pass  # then it ends in half a record, which readers of broken files skip
        self._error = ending(self.path, error, self._setting)
