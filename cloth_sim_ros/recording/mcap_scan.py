# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""All that is whole in an mcap file, whatever became of the rest."""

from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import IO

from cloth_sim_ros.files.regular_file import open_regular
from cloth_sim_ros.recording.mcap_records import chunk_records
from cloth_sim_ros.recording.mcap_records import HEAD
from cloth_sim_ros.recording.mcap_records import is_read
from cloth_sim_ros.recording.mcap_records import MAGIC
from cloth_sim_ros.recording.mcap_records import read_record
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Chunk
from mcap.records import McapRecord
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
                except Exception:  # what a damaged byte raises can be anything
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
