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

"""One mcap file as rosbag2 writes it, with its metadata.yaml."""

import os
from pathlib import Path

from cloth_sim_ros.messages.topic import Topic
from cloth_sim_ros.recording.bag_metadata import BagMetadata
from cloth_sim_ros.recording.message_definition import message_definition
from cloth_sim_ros.recording.message_definition import type_hash
from cloth_sim_ros.recording.offered_qos import offered_qos
from cloth_sim_ros.recording.project_version import PACKAGE
from cloth_sim_ros.recording.project_version import project_version
from cloth_sim_ros.recording.yaml_text import yaml_text
from mcap.writer import CompressionType
from mcap.writer import Writer

CHUNK_BYTES = 1024 * 1024


class BagFile:
    """
    Writes messages into ``folder``; used from one thread.

    After each flush, all before it is readable whatever happens to the process.

    :param folder: empty, the bag takes its name
    :param node_name: with its namespace, for the names of the topics
    """

    def __init__(self, folder: Path, node_name: str) -> None:
        """Open the file; OSError when that cannot be."""
        self._folder = folder
        self._node_name = node_name
        self._path = folder / f'{folder.name}_0.mcap'
        self._metadata = BagMetadata(self._path.name, {PACKAGE: project_version()})
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}
        self._stream = open(self._path, 'xb')
        try:
            self._writer = Writer(
                self._stream, chunk_size=CHUNK_BYTES, compression=CompressionType.ZSTD)
            self._writer.start(profile='ros2')
            self._add_metadata()
            self.flush()
        except OSError:
            self._stream.close()
            raise

    def write(self, topic: Topic, data: bytes, time: int) -> None:
        """Write the serialised message ``data`` of ``topic`` at ``time`` [ns]."""
        name = topic.full_name(self._node_name)
        if name not in self._channels:
            self._add_topic(name, topic)
        self._writer.add_message(self._channels[name], time, data, time)
        self._metadata.add_message(name, time)

    def flush(self) -> None:
        """Hand everything so far to the operating system, in whole records."""
        self._writer.flush()
        self._kept_bytes = self._stream.tell()
        self._metadata.write(self._folder)

    def finish(self) -> None:
        """Write the index and close the file."""
        self._writer.flush()
        self._add_metadata()
        self._writer.finish()
        self._stream.close()
        self._metadata.write(self._folder)

    def abandon(self) -> None:
        """Close the file after a failed write, and cut off what came after the last flush."""
        try:
            self._stream.close()
        except OSError:
            pass  # the bytes that could not be written before still can't be
        os.truncate(self._path, self._kept_bytes)

    def _add_metadata(self) -> None:
        self._writer.add_metadata('rosbag2', {'serialized_metadata': self._metadata.text()})

    def _add_topic(self, name: str, topic: Topic) -> None:
        if topic.type_name not in self._schemas:
            self._schemas[topic.type_name] = self._writer.register_schema(
                topic.type_name, 'ros2msg', message_definition(topic.type_name).encode())
        self._channels[name] = self._writer.register_channel(
            name, 'cdr', self._schemas[topic.type_name], {
                'offered_qos_profiles': yaml_text(offered_qos(topic)),
                'topic_type_hash': type_hash(topic.type_name)})
        self._metadata.add_topic(name, topic)
