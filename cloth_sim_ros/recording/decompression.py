# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Decompress parts of bags, of bounded size."""

from io import BytesIO
from pathlib import Path
from typing import BinaryIO

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.files.regular_file import open_regular

# Max. decompressed size: _SPARE [bytes] plus _GAIN [1] times the compressed size. A cloth at rest
# has the same bits in each frame and reaches a ratio of nearly 100.
_SPARE = 64 << 20
_GAIN = 256
_WINDOW = 1 << 27  # max. window [bytes]; the default limit of zstd
_BLOCK = 1 << 20


def most_bytes(compressed: int) -> int:
    """Return the max. decompressed size of ``compressed`` bytes [bytes]."""
    return _SPARE + _GAIN * compressed


def decompress(data: bytes, compression: str, size: int) -> bytes:
    """
    Return the ``size`` bytes that ``data`` stands for.

    :param compression: zstd, lz4, or empty for none
    :raises ValueError: when it stands for another number of bytes, or for too many
    :raises Exception: of other kinds, of the decompressors
    """
    if size > most_bytes(len(data)):
        raise ValueError(f'{size} bytes are declared of {len(data)} compressed ones')
    if compression == 'zstd':
        with _zstd_reader(BytesIO(data)) as reader:
            result = reader.read(size + 1)
    elif compression == 'lz4':
        from lz4.frame import LZ4FrameDecompressor
        result = LZ4FrameDecompressor().decompress(data, max_length=size + 1)
    elif not compression:
        result = data
    else:
        raise ValueError(f'the compression {shown(compression[:20])} is unknown')
    if len(result) != size:
        raise ValueError(f'{size} bytes are declared and there are {_or_more(len(result), size)}')
    return result


def decompress_message(data: bytes) -> bytes:
    """Return the message that ``data`` is by zstd; ValueError when it is too large."""
    most = most_bytes(len(data))
    parts = []
    with _zstd_reader(BytesIO(data)) as reader:
        while part := reader.read(_BLOCK):
            parts.append(part)
            most -= len(part)
            if most < 0:
                raise ValueError(f'more than {most_bytes(len(data))} bytes come of {len(data)}')
    return b''.join(parts)


def decompress_file(source: Path, target: Path) -> None:
    """
    Write what the file ``source`` is by zstd into ``target``.

    :raises OSError: when one of them can't be read or written
    :raises ValueError: when it is too large
    :raises Exception: of other kinds, of the decompressor
    """
    with open_regular(source) as compressed, target.open('wb') as file:
        most = most_bytes(compressed.seek(0, 2))
        compressed.seek(0)
        with _zstd_reader(compressed) as reader:
            while part := reader.read(_BLOCK):
                if file.tell() + len(part) > most:
                    raise ValueError(f'more than {most} bytes come of it')
                file.write(part)


def _zstd_reader(stream: BinaryIO) -> BinaryIO:
    # The decompressors are needed for some bags only, and not by a node.
    from zstandard import ZstdDecompressor
    return ZstdDecompressor(max_window_size=_WINDOW).stream_reader(
        stream, read_across_frames=True, closefd=False)


def _or_more(count: int, size: int) -> str:
    return f'{count} or more' if count > size else str(count)
