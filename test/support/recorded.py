# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

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
