# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Mcap files whose chunks, records and definitions are made to do harm."""

from io import BytesIO
from pathlib import Path
import struct

import lz4.frame
from mcap.data_stream import RecordBuilder
from mcap.records import Channel
from mcap.records import Chunk
from mcap.records import ChunkIndex
from mcap.records import Footer
from mcap.records import Header
from mcap.records import Schema
from mcap.records import Statistics
import zstandard

MAGIC = b'\x89MCAP0\r\n'
TOPIC, TYPE = '/cloth_sim/stats', 'cloth_sim_interfaces/msg/ClothStats'
_GIB = 1 << 30


def zeros(count: int) -> bytes:
    """Return ``count`` zeros by zstd, in many parts."""
    compressor = zstandard.ZstdCompressor().compressobj()
    block = bytes(1 << 24)
    return b''.join(
        [compressor.compress(block) for _ in range(count >> 24)] + [compressor.flush()])


def frame_of(declared: int) -> bytes:
    """Return a frame of zstd that declares so many bytes, and holds none."""
    return b'\x28\xb5\x2f\xfd\xe0' + struct.pack('<Q', declared) + b'\x01\x00\x00'


def wide_window() -> bytes:
    """Return a frame of zstd that asks for a window of 2 TiB."""
    return b'\x28\xb5\x2f\xfd\x00\xf8' + b'\x01\x00\x00'


BOMB = zeros(2 * _GIB)
# Each the compression, the data and the size that is declared.
CHUNKS = {
    'zstd bomb': ('zstd', BOMB, 2 * _GIB),
    'zstd bomb declared small': ('zstd', BOMB, 1000),
    'zstd in many frames': ('zstd', zeros(1 << 24) * 1000, 1000),
    'zstd declared too large': ('zstd', frame_of(1 << 62), 1 << 62),
    'zstd frame declared too large': ('zstd', frame_of(1 << 62), 100),
    'zstd window': ('zstd', wide_window(), 100),
    'lz4 bomb': ('lz4', lz4.frame.compress(bytes(1 << 28)) * 8, 1 << 31),
    'lz4 bomb declared small': ('lz4', lz4.frame.compress(bytes(1 << 28)), 100),
    'nothing declared huge': ('', b'', 1 << 63),
    'another compression': ('x' * 1000, b'x', 1),
    'a record of 2^63 bytes': ('', struct.pack('<BQ', 5, 1 << 63) + b'x', 10),
    'a message of no bytes': ('', struct.pack('<BQ', 5, 0), 9),
    'a chunk in a chunk': ('', struct.pack('<BQ', 6, 30) + bytes(30), 39),
    'a million records': ('zstd', zstandard.compress(struct.pack('<BQ', 99, 0) * 1_000_000),
                          9_000_000),
}
_STRUCTS = '\n'.join(
    f'{"=" * 80}\nMSG: a/msg/T{i}\nT{i + 1} a\nT{i + 1} b\n' for i in range(60))
# Text of MSG, or of IDL where it begins so.
DEFINITIONS = {
    'a long array of words': 'string[1000000000] a\n',
    'a long array of messages': f'B[100000000] a\n{"=" * 80}\nMSG: a/msg/B\nuint8 x\n',
    'doubled 60 times': f'a/T0 a\n{_STRUCTS}{"=" * 80}\nMSG: a/msg/T60\nuint8[0] x\n',
    'within itself': f'A[] a\n{"=" * 80}\nMSG: a/msg/A\nA x\n',
    'a long text': 'uint8 x\n' * 1_000_000, 'a long word': 'uint8 ' + 'x' * 1_000_000 + '\n',
    'a number of many digits': f'uint8 A={"9" * 100_000}\n',
    'no definition': '\x00\xff[[[', 'quotes': 'string a "' + '\\"' * 50_000 + '\n',
    'code': 'uint8 a\n__import__("os").system("false") b\n',
    'idl parentheses': f'IDL const long A = {"(" * 40}1{")" * 40};',
    'idl sequences': f'IDL struct A {{ {"sequence<" * 40}long{">" * 40} a; }};',
    'idl shifts': 'IDL const long A = 1 << 1 << 1000000000000;',
    'idl operators': 'IDL const long A = ' + '1|1&1^1+1*' * 2000 + '1;',
    'idl modules': 'IDL ' + 'module a { ' * 5000,
    'idl annotations': 'IDL ' + '@a(b=(((((((1))))))) ' * 1000,
    'idl comment': 'IDL /*' + '"' * 100_001,
}


def _written(*records) -> bytes:
    builder = RecordBuilder()
    for record in records:
        record.write(builder)
    return builder.end()


def _head(path: Path, text: str, encoding: str) -> tuple[BytesIO, list]:
    known = [
        Schema(id=1, name=TYPE, encoding=encoding, data=text.encode()),
        Channel(id=1, topic=TOPIC, message_encoding='cdr', metadata={}, schema_id=1)]
    stream = BytesIO()
    stream.write(MAGIC + _written(Header('ros2', 'test')))
    return stream, known


def write_chunk(path: Path, name: str, has_index: bool) -> None:
    """Write a file with one hostile chunk."""
    compression, data, size = CHUNKS[name]
    _write(path, 'float64 dt\n', 'ros2msg', Chunk(
        compression=compression, data=data, message_start_time=0, message_end_time=1,
        uncompressed_crc=0, uncompressed_size=size), has_index)


def write_definition(path: Path, name: str) -> None:
    """Write a whole file with one message of a hostile type."""
    text = DEFINITIONS[name]
    encoding = 'ros2idl' if text.startswith('IDL ') else 'ros2msg'
    data = b'\x00\x01\x00\x00' + bytes(64)
    content = struct.pack('<BQHIQQ', 5, 22 + len(data), 1, 0, 0, 0) + data
    _write(path, text.removeprefix('IDL '), encoding, Chunk(
        compression='', data=content, message_start_time=0, message_end_time=1,
        uncompressed_crc=0, uncompressed_size=len(content)), True)


def _write(path: Path, text: str, encoding: str, chunk: Chunk, has_index: bool) -> None:
    stream, known = _head(path, text, encoding)
    stream.write(_written(*known))
    begin = stream.tell()
    stream.write(_written(chunk))
    if has_index:
        summary = stream.tell()
        stream.write(_written(
            *known,
            ChunkIndex(
                chunk_length=summary - begin, chunk_start_offset=begin,
                compression=chunk.compression, compressed_size=len(chunk.data),
                message_end_time=1, message_index_length=0, message_index_offsets={},
                message_start_time=0, uncompressed_size=chunk.uncompressed_size),
            Statistics(
                attachment_count=0, channel_count=1, channel_message_counts={1: 1},
                chunk_count=1, message_count=1, message_end_time=1, message_start_time=0,
                metadata_count=0, schema_count=1),
            Footer(summary_start=summary, summary_offset_start=0, summary_crc=0)))
        stream.write(MAGIC)
    path.write_bytes(stream.getvalue())
