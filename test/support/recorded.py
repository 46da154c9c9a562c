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

"""A recording read back with two independent libraries."""

from pathlib import Path
from typing import Any

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader


class Recorded:
    """
    The messages of a recording, as mcap_ros2 decodes them.

    :param folder: of the recording; its metadata.yaml must be there, and rosbags must read it
    """

    def __init__(self, folder: Path) -> None:
        """Read all of it."""
        with AnyReader([folder]) as reader:
            self.topics = {
                connection.topic: connection.msgtype for connection in reader.connections}
            rosbags_count = sum(1 for _ in reader.messages())
        file, = folder.glob('*.mcap')
        with file.open('rb') as stream:
            reader = make_reader(stream, decoder_factories=[DecoderFactory()])
            self.entries = [
                (channel.topic, record.log_time, message)
                for _, channel, record, message in reader.iter_decoded_messages()]
        assert len(self.entries) == rosbags_count, 'the two libraries disagree'

    def messages(self, key: str) -> list[Any]:
        """Return the messages of the node's topic ``key`` in their order."""
        return [
            message for topic, _, message in self.entries if topic.endswith(f'/cloth_sim/{key}')]
