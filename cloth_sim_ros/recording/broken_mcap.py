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


"""The messages of an mcap file without its end: a run that was killed, or is under way."""

from collections import Counter
from collections.abc import Collection
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path

from cloth_sim_ros.recording.bag_topic import BagTopic
from cloth_sim_ros.recording.bag_topic import RawMessage
from cloth_sim_ros.recording.mcap_channels import McapChannels
from cloth_sim_ros.sim.errors import ClothSimError
from mcap.records import Chunk
from mcap.records import Footer
from mcap.records import McapRecord
from mcap.records import Message
from mcap.records import MessageIndex
from mcap.stream_reader import breakup_chunk
from mcap.stream_reader import StreamReader

MAGIC = b'\x89MCAP0\r\n'


class BrokenMcap:
    """
    Reads whole records from the front, up to where the file ends or makes no sense.

    ``problem`` says where that was; it is empty when the file turned out to have its end.

    :raises ClothSimError: when it is no mcap file, or can't be opened
    """

    def __init__(self, path: Path) -> None:
        """Look at the first bytes."""
        self.path = path
        self.problem = ''
        try:
            with open(path, 'rb') as stream:
                begin = stream.read(len(MAGIC))
        except OSError as error:
            raise ClothSimError(
                f'{path} cannot be opened ({error.strerror}): give a file you may read'
            ) from error
        if not begin:
            raise ClothSimError(f'{path} is empty: give a recording that was begun')
        if begin != MAGIC:
            raise ClothSimError(f'{path} is no mcap file: give the folder of a recording')

    @cached_property
    def topics(self) -> list[BagTopic]:
        """Get the topics. Chunks are unpacked only where their index names a new one."""
        channels = McapChannels()
        counts: Counter[int] = Counter()
        chunk = None
        indexed = False

        def read_last_chunk() -> None:
            for record in self._unpacked(chunk) if chunk else ():
                channels.read(record)
                if isinstance(record, Message) and not indexed:
                    counts[record.channel_id] += 1

        for record in self._records():
            channels.read(record)
            if isinstance(record, Chunk):
                if not indexed:
                    read_last_chunk()
                chunk, indexed = record, False
            elif isinstance(record, MessageIndex):
                indexed = True
                counts[record.channel_id] += len(record.records)
                if record.channel_id not in channels:
                    read_last_chunk()
            elif isinstance(record, Message):
                counts[record.channel_id] += 1
        # The cut may have taken its index, or a part of it.
        read_last_chunk()
        return channels.topics(counts)

    def messages(self, names: Collection[str] | None) -> Iterator[RawMessage]:
        """Yield the messages of the topics ``names``, or of all, as they stand in the file."""
        channels = McapChannels()
        for record in self._flat_records():
            channels.read(record)
            if isinstance(record, Message) and record.channel_id in channels:
                topic, type_name = channels.name(record.channel_id)
                if names is None or topic in names:
                    yield RawMessage(topic, type_name, record.log_time, record.data)

    def _flat_records(self) -> Iterator[McapRecord]:
        """Yield the records, those in chunks too, up to the first that is not whole."""
        for record in self._records():
            if isinstance(record, Chunk):
                records = self._unpacked(record)
                if not records:
                    return
                yield from records
            else:
                yield record

    def _records(self) -> Iterator[McapRecord]:
        """Yield the records, chunks as they are, up to the first that is not whole."""
        self.problem = ''
        has_end = False
        with open(self.path, 'rb') as stream:
            try:
                for record in StreamReader(stream, emit_chunks=True).records:
                    has_end = isinstance(record, Footer)
                    yield record
            except Exception as error:  # what half a record raises can be anything
                if not has_end:
                    self._end(error)

    def _unpacked(self, chunk: Chunk) -> list[McapRecord]:
        """Return what is in ``chunk``; nothing when it is damaged."""
        try:
            return breakup_chunk(chunk, validate_crc=True)
        except Exception as error:  # what a damaged byte raises can be anything
            self._end(error)
            return []

    def _end(self, error: Exception) -> None:
        reason = f' ({error})' if str(error) else ''
        self.problem = f'{self.path.name} is cut off: read up to its last whole record{reason}'
