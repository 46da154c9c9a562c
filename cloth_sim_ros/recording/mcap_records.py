# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The records of an mcap file, and the topics that they have declared so far."""

from collections.abc import Collection
from collections.abc import Iterator
from collections.abc import Mapping
from io import BytesIO
import struct
from typing import BinaryIO
import zlib

from cloth_sim_ros.recording.bag_messages import BagTopic
from cloth_sim_ros.recording.bag_messages import recorded_qos
from cloth_sim_ros.recording.decompression import decompress
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Channel
from mcap.records import Chunk
from mcap.records import ChunkIndex
from mcap.records import Footer
from mcap.records import McapRecord
from mcap.records import Message
from mcap.records import MessageIndex
from mcap.records import Schema
from mcap.records import Statistics
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import MessageDefinitionFormat

HEAD = struct.Struct('<BQ')  # of each record: its kind, and its length behind that [bytes]
MESSAGE_HEAD = struct.Struct('<HIQQ')  # channel, sequence, times logged and published [ns]

_READ = {
    Opcode.CHANNEL: Channel.read, Opcode.CHUNK: Chunk.read, Opcode.CHUNK_INDEX: ChunkIndex.read,
    Opcode.FOOTER: Footer.read, Opcode.MESSAGE_INDEX: MessageIndex.read,
    Opcode.SCHEMA: Schema.read, Opcode.STATISTICS: Statistics.read}
_FORMATS = {'ros2msg': MessageDefinitionFormat.MSG, 'ros2idl': MessageDefinitionFormat.IDL}


def read_records(stream: BinaryIO, end: int) -> Iterator[McapRecord]:
    """
    Yield the records from the present place of ``stream`` on, chunks as they are.

    Kinds that tell nothing of messages are passed over.

    :param end: place behind the last record [bytes]
    :raises ValueError: at a record that is not whole
    :raises Exception: of other kinds, at one that makes no sense
    """
    place = stream.tell()
    while place < end:
        head = stream.read(HEAD.size)
        if len(head) < HEAD.size:
            raise ValueError(f'{len(head)} bytes are left at {place}')
        opcode, length = HEAD.unpack(head)
        place += HEAD.size
        if length > end - place:
            raise ValueError(
                f'a record of {length} bytes at {place}, where {end - place} are left')
        if is_read(opcode):
            yield read_record(opcode, stream.read(length))
        else:
            stream.seek(length, 1)
        place += length


def chunk_content(chunk: Chunk) -> bytes:
    """Return the records in ``chunk``, decompressed; ValueError when they are not as declared."""
    content = decompress(chunk.data, chunk.compression, chunk.uncompressed_size)
    if chunk.uncompressed_crc and zlib.crc32(content) != chunk.uncompressed_crc:
        raise ValueError('its checksum does not match')
    return content


def chunk_records(chunk: Chunk) -> Iterator[McapRecord]:
    """Yield the records in ``chunk``; Exceptions as those of read_records."""
    content = chunk_content(chunk)
    yield from read_records(BytesIO(content), len(content))


def is_read(opcode: int) -> bool:
    """Return whether records of this kind are of use here."""
    return opcode == Opcode.MESSAGE or opcode in _READ


def read_record(opcode: int, payload: bytes) -> McapRecord:
    """Return the record that ``payload`` holds; Exception of many kinds when it makes no sense."""
    if opcode != Opcode.MESSAGE:
        return _READ[Opcode(opcode)](ReadDataStream(BytesIO(payload)))
    channel, sequence, logged, published = MESSAGE_HEAD.unpack_from(payload)
    return Message(
        channel_id=channel, log_time=logged, data=payload[MESSAGE_HEAD.size:],
        publish_time=published, sequence=sequence)


class McapChannels:
    """The channels of an mcap file by their number, with the schemas they name."""

    def __init__(self) -> None:
        """Begin with none."""
        self._schemas: dict[int, Schema] = {}
        self._channels: dict[int, Channel] = {}

    def read(self, record: McapRecord) -> None:
        """Store a schema or a channel; ignore any other record."""
        if isinstance(record, Schema):
            self._schemas[record.id] = record
        elif isinstance(record, Channel):
            self._channels[record.id] = record

    def __contains__(self, number: int) -> bool:
        """Return whether the channel ``number`` is known."""
        return number in self._channels

    def name(self, number: int) -> tuple[str, str]:
        """Return topic and type of a channel; the type is empty when its schema is missing."""
        channel = self._channels[number]
        schema = self._schemas.get(channel.schema_id)
        return channel.topic, schema.name if schema is not None else ''

    def named(self, names: Collection[str] | None) -> dict[int, tuple[str, str]]:
        """Return topic and type of the channels of the topics ``names``, or of all."""
        told = {number: self.name(number) for number in self._channels}
        return {
            number: pair for number, pair in told.items() if names is None or pair[0] in names}

    def topics(self, counts: Mapping[int, int]) -> list[BagTopic]:
        """Return all channels as topics, with the numbers of their messages."""
        return [
            BagTopic(
                *self.name(number), recorded_qos(channel.metadata.get('offered_qos_profiles')),
                counts.get(number, 0), _definition(self._schemas.get(channel.schema_id)))
            for number, channel in self._channels.items()]


def _definition(schema: Schema | None) -> MessageDefinition:
    if schema is None or schema.encoding not in _FORMATS:
        return MessageDefinition(MessageDefinitionFormat.NONE, '')
    return MessageDefinition(_FORMATS[schema.encoding], schema.data.decode(errors='replace'))
