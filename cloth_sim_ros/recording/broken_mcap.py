# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""An mcap file without its end, or damaged: its messages, and all that is whole in it."""

from collections import Counter
from collections.abc import Collection
from collections.abc import Generator
from collections.abc import Iterator
from functools import cached_property
from io import BytesIO
import math
from pathlib import Path
from typing import IO

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.regular_file import open_regular
from cloth_sim_ros.recording.bag_folder import MAGIC
from cloth_sim_ros.recording.bag_messages import BagTopic
from cloth_sim_ros.recording.bag_messages import RawMessage
from cloth_sim_ros.recording.mcap_records import chunk_records
from cloth_sim_ros.recording.mcap_records import HEAD
from cloth_sim_ros.recording.mcap_records import is_read
from cloth_sim_ros.recording.mcap_records import McapChannels
from cloth_sim_ros.recording.mcap_records import read_record
from cloth_sim_ros.recording.mcap_records import read_records
from cloth_sim_ros.recording.recording_faults import nothing_flushed
from cloth_sim_ros.sim.errors import ClothSimError
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Chunk
from mcap.records import Footer
from mcap.records import McapRecord
from mcap.records import Message
from mcap.records import MessageIndex
from mcap.records import Metadata


class McapScan:
    """
    Reads a file from its begin to its end, or to where it is cut, past damaged chunks.

    ``problems`` names what was missing, one phrase each; it is complete when a walk through the
    records has ended.
    """

    def __init__(self, path: Path) -> None:
        """Keep the path; nothing is read yet."""
        self.path = path
        self.problems: list[str] = []

    def records(self) -> Iterator[McapRecord]:
        """
        Yield schemas, channels, messages and metadata, those in chunks too.

        :raises OSError: when the file can't be read
        """
        self.problems = []
        damaged = 0
        with open_regular(self.path) as stream:
            for opcode, content in self._frames(stream):
                try:
                    records = _parsed(opcode, content)
                except Exception:  # a damaged byte can raise anything
                    damaged += 1
                    continue
                yield from records
        if damaged:
            self.problems.append(f'the contents of {damaged} damaged records')

    def _frames(self, stream: IO[bytes]) -> Iterator[tuple[int, bytes]]:
        """Yield opcode and content of each record; a damaged content moves none behind it."""
        length = self.path.stat().st_size
        if stream.read(len(MAGIC)) != MAGIC:
            self.problems.append('the beginning of an mcap file')
            return
        while True:
            place = stream.tell()
            head = stream.read(HEAD.size)
            opcode, size = HEAD.unpack(head) if len(head) == HEAD.size else (0, length)
            if stream.tell() + size > length:
                self.problems.append(
                    'its index' if place == length
                    else f'everything after its first {place} of {length} bytes')
                return
            yield opcode, stream.read(size)
            if opcode == Opcode.FOOTER:
                if stream.read(len(MAGIC)) != MAGIC:
                    self.problems.append('its last bytes')
                return


def _parsed(opcode: int, content: bytes) -> list[McapRecord]:
    if opcode == Opcode.METADATA:
        return [Metadata.read(ReadDataStream(BytesIO(content)))]
    if not is_read(opcode):
        return []
    record = read_record(opcode, content)
    return list(chunk_records(record)) if isinstance(record, Chunk) else [record]


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
            with open_regular(path) as stream:
                begin = stream.read(len(MAGIC))
        except OSError as error:
            raise ClothSimError(
                f'{path} cannot be opened ({error.strerror}): give a file you may read'
            ) from error
        if not begin:
            raise nothing_flushed(path, 'is empty')
        if begin != MAGIC and MAGIC.startswith(begin):
            raise nothing_flushed(path, f'has {len(begin)} bytes')
        if begin != MAGIC:
            raise ClothSimError(f'{path} is not an mcap file: give the folder of a recording')

    @cached_property
    def topics(self) -> list[BagTopic]:
        """Get the topics. Chunks are unpacked only where their index names a new one."""
        channels = McapChannels()
        counts: Counter[int] = Counter()
        indexed: Counter[int] = Counter()  # what the index of the last chunk says
        chunk: Chunk | None = None

        def unpack() -> Counter[int]:
            found: Counter[int] = Counter()
            if chunk is None:
                return found
            for record in self._unpacked(chunk):
                channels.read(record)
                if isinstance(record, Message):
                    found[record.channel_id] += 1
            return found

        for record in self._records():
            channels.read(record)
            if isinstance(record, Chunk):
                counts += indexed or unpack()
                chunk, indexed = record, Counter()
            elif isinstance(record, MessageIndex):
                indexed[record.channel_id] += len(record.records)
                if record.channel_id not in channels:
                    unpack()
            elif isinstance(record, Message):
                counts[record.channel_id] += 1
        # The cut may have taken a part of the last index.
        counts += unpack()
        return channels.topics(counts)

    @cached_property
    def span(self) -> tuple[int, int] | None:
        """Get the times of the first and the last message [ns]; None without one."""
        times: list[int] = []
        for record in self._records():
            if isinstance(record, Chunk):
                # Without a message a chunk has times too, of 0.
                if record.message_end_time or any(
                        isinstance(part, Message) for part in self._unpacked(record)):
                    times += record.message_start_time, record.message_end_time
            elif isinstance(record, Message):
                times.append(record.log_time)
        return (min(times), max(times)) if times else None

    def messages(
            self, names: Collection[str] | None, begin: int | None = None,
            end: int | None = None) -> Iterator[RawMessage]:
        """
        Yield the messages of the topics ``names``, or of all, as they stand in the file.

        Those from ``begin`` on and before ``end`` [ns], where these are given.
        """
        first = -math.inf if begin is None else begin
        past = math.inf if end is None else end
        channels = McapChannels()
        for record in self._flat_records():
            channels.read(record)
            if isinstance(record, Message) and record.channel_id in channels:
                topic, type_name = channels.name(record.channel_id)
                if first <= record.log_time < past and (names is None or topic in names):
                    yield RawMessage(topic, type_name, record.log_time, record.data)

    def _flat_records(self) -> Iterator[McapRecord]:
        """Yield the records, those in chunks too, up to the first that is not whole."""
        for record in self._records():
            if isinstance(record, Chunk):
                is_whole = yield from self._unpacked(record)
                if not is_whole:
                    return
            else:
                yield record

    def _records(self) -> Iterator[McapRecord]:
        """Yield the records, chunks as they are, up to the first that is not whole."""
        self.problem = ''
        has_end = False
        with open_regular(self.path) as stream:
            end = stream.seek(0, 2)
            stream.seek(len(MAGIC))
            try:
                for record in read_records(stream, end):
                    has_end = isinstance(record, Footer)
                    yield record
                    if has_end:
                        break
                else:
                    raise EOFError
            except Exception as error:  # what half a record raises can be anything
                if not has_end:
                    self._end(error)

    def _unpacked(self, chunk: Chunk) -> Generator[McapRecord, None, bool]:
        """Yield what is in ``chunk``, up to where it is damaged; return whether it is whole."""
        try:
            yield from chunk_records(chunk)
        except Exception as error:  # a damaged byte can raise anything
            self._end(error)
            return False
        return True

    def _end(self, error: Exception) -> None:
        reason = f' ({cut(error)})' if str(error) else ''
        self.problem = (
            f'{self.path.name} is truncated: read up to its last complete record{reason}')
