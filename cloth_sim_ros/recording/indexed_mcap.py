# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The messages of an mcap file with its end, by the index that stands there."""

from collections.abc import Collection
from collections.abc import Iterator
import heapq
import math
from operator import itemgetter
from pathlib import Path
from typing import BinaryIO

from cloth_sim_ros.files.regular_file import open_regular
from cloth_sim_ros.recording.bag_folder import MAGIC
from cloth_sim_ros.recording.bag_messages import RawMessage
from cloth_sim_ros.recording.decompression import most_bytes
from cloth_sim_ros.recording.mcap_records import chunk_content
from cloth_sim_ros.recording.mcap_records import HEAD
from cloth_sim_ros.recording.mcap_records import McapChannels
from cloth_sim_ros.recording.mcap_records import MESSAGE_HEAD
from cloth_sim_ros.recording.mcap_records import read_records
from mcap.opcode import Opcode
from mcap.records import Chunk
from mcap.records import ChunkIndex
from mcap.records import Footer
from mcap.records import Statistics

_FOOTER_BYTES = HEAD.size + 20
# Chunks whose times overlap are in memory together [bytes].
_MOST_AT_ONCE = 256 << 20

# Time, number of the chunk and place in it, which are never equal; then topic, type and data.
_Entry = tuple[int, int, int, str, str, bytes]


class IndexedMcap:
    """
    Reads a file that was finished.

    ``problem`` says where reading had to end; it is empty while all went well.

    :raises ValueError: when it has no whole index, or one that contradicts the file
    :raises Exception: of other kinds, for an index that makes no sense
    """

    def __init__(self, path: Path) -> None:
        """Read the index."""
        self.path = path
        self.problem = ''
        self._channels = McapChannels()
        self._chunks: list[ChunkIndex] = []
        statistics = None
        with open_regular(path) as stream:
            begin, end = _summary(stream)
            stream.seek(begin)
            for record in read_records(stream, end):
                self._channels.read(record)
                if isinstance(record, ChunkIndex):
                    self._chunks.append(record)
                elif isinstance(record, Statistics):
                    statistics = record
        if statistics is None or statistics.chunk_count != len(self._chunks):
            raise ValueError('its index is incomplete')
        if statistics.message_count and not self._chunks:
            raise ValueError('its messages are not in chunks')
        counts = statistics.channel_message_counts
        if any(number not in self._channels for number in counts):
            raise ValueError('its index lacks topics')
        _check_chunks(self._chunks, begin)
        self.topics = self._channels.topics(counts)
        # Times of the first and the last message [ns].
        self.span = (
            (statistics.message_start_time, statistics.message_end_time)
            if statistics.message_count else None)

    def messages(
            self, names: Collection[str] | None, begin: int | None = None,
            end: int | None = None) -> Iterator[RawMessage]:
        """
        Yield the messages of the topics ``names``, or of all, in the order of their times.

        Those from ``begin`` on and before ``end`` [ns], where these are given.
        """
        wanted = self._channels.named(names)
        times = (-math.inf if begin is None else begin, math.inf if end is None else end)
        try:
            # A stream of its own for each walk: two walks would move one file's place.
            with open_regular(self.path) as stream:
                for entry in heapq.merge(*(
                        _entries(stream, number, index, wanted, times)
                        for number, index in enumerate(self._chunks)
                        if _may_hold(index, wanted, times)), key=itemgetter(0, 1, 2)):
                    time, _, place, topic, type_name, data = entry
                    if place:
                        yield RawMessage(topic, type_name, time, data)
        except Exception as error:  # a damaged byte can raise anything
            self.problem = (
                f'{self.path.name} is damaged: read up to there '
                f'({error or type(error).__name__})')


def _summary(stream: BinaryIO) -> tuple[int, int]:
    """Return where the index begins and ends [bytes]."""
    if stream.read(len(MAGIC)) != MAGIC:
        raise ValueError('it is not an mcap file')
    end = stream.seek(0, 2) - len(MAGIC) - _FOOTER_BYTES
    if end < len(MAGIC):
        raise ValueError('it is too short for an index')
    stream.seek(end)
    footer = next(read_records(stream, end + _FOOTER_BYTES))
    if stream.read() != MAGIC or not isinstance(footer, Footer):
        raise ValueError('it has no end')
    if not len(MAGIC) < footer.summary_start <= end:
        raise ValueError('it has no index')
    return footer.summary_start, end


def _check_chunks(chunks: list[ChunkIndex], end: int) -> None:
    """Raise ValueError for chunks beyond ``end`` [bytes], in one another, or too large."""
    place = len(MAGIC)
    for chunk in sorted(chunks, key=lambda each: each.chunk_start_offset):
        if chunk.chunk_start_offset < place:
            raise ValueError('two of its chunks overlap')
        place = chunk.chunk_start_offset + chunk.chunk_length
        if chunk.uncompressed_size > most_bytes(chunk.compressed_size):
            raise ValueError('one of its chunks declares too many bytes')
    if place > end:
        raise ValueError('one of its chunks is beyond its end')
    # Begins sort before ends at the same time.
    edges = sorted(
        edge for chunk in chunks for edge in (
            (chunk.message_start_time, 0, chunk.uncompressed_size),
            (chunk.message_end_time, 1, -chunk.uncompressed_size)))
    at_once = 0
    for *_, size in edges:
        at_once += size
        # One chunk has to be read in any case.
        if at_once > _MOST_AT_ONCE and at_once != size:
            raise ValueError('too many of its chunks have the same times')


def _may_hold(
        index: ChunkIndex, wanted: dict[int, tuple[str, str]],
        times: tuple[float, float]) -> bool:
    numbers = index.message_index_offsets
    return (
        index.message_end_time >= times[0] and index.message_start_time < times[1]
        and bool(wanted) and (not numbers or not wanted.keys().isdisjoint(numbers)))


def _entries(
        stream: BinaryIO, number: int, index: ChunkIndex, wanted: dict[int, tuple[str, str]],
        times: tuple[float, float]) -> Iterator[_Entry]:
    """Yield the begin of a chunk, so that it is read no sooner, and then its messages."""
    yield index.message_start_time, number, 0, '', '', b''
    stream.seek(index.chunk_start_offset)
    chunk = next(read_records(stream, index.chunk_start_offset + index.chunk_length))
    if not isinstance(chunk, Chunk) or chunk.uncompressed_size != index.uncompressed_size:
        raise ValueError(f'there is no such chunk at {index.chunk_start_offset}')
    entries: list[_Entry] = []
    content = chunk_content(chunk)
    place = 0
    while place < len(content):
        opcode, length = HEAD.unpack_from(content, place)
        place += HEAD.size
        if length > len(content) - place:
            raise ValueError(f'a record of {length} bytes is longer than its chunk')
        if opcode == Opcode.MESSAGE:
            channel, _, time, _ = MESSAGE_HEAD.unpack_from(content, place)
            if channel in wanted and times[0] <= time < times[1]:
                data = content[place + MESSAGE_HEAD.size:place + length]
                entries.append((time, number, place, *wanted[channel], data))
        place += length
    entries.sort(key=itemgetter(0, 2))
    yield from entries
