# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How long an mcap file will be once it is finished, before it is."""

# Of the records of the format, with opcode and length [bytes].
_MESSAGE = 31            # without its data
_MESSAGE_INDEX = 15      # of a channel in a chunk
_MESSAGE_INDEX_ENTRY = 16
_CHUNK = 60              # without what is in it
_CHUNK_INDEX = 100
_CHUNK_INDEX_ENTRY = 10  # of a channel
_STATISTICS_ENTRY = 10   # of a channel
# Statistics, offsets, the end of data, the footer and the last magic, with room to spare.
_END = 1024


class McapSize:
    """
    A bound of the finished length of a file that is being written.

    It counts the chunk under way as if it could not be compressed, and the index at the end.
    """

    def __init__(self) -> None:
        """Begin with an empty file."""
        self._position = 0
        self._channels = 0
        self._chunk = 0       # records in the chunk under way, and their index
        self._summary = _END

    def add_channel(self, length: int) -> None:
        """Count a channel whose name, type, definition and metadata have ``length`` bytes."""
        self._channels += 1
        # It stands in the data and again in the summary.
        self._chunk += length + _MESSAGE_INDEX
        self._summary += length + _STATISTICS_ENTRY

    def add_message(self, length: int) -> None:
        """Count a message of ``length`` bytes."""
        self._chunk += length + _MESSAGE + _MESSAGE_INDEX_ENTRY

    def set_position(self, position: int) -> None:
        """Note that the file has ``position`` bytes; where it has grown, a chunk was finished."""
        if position != self._position:
            self._position = position
            self._chunk = self._channels * _MESSAGE_INDEX
            self._summary += _CHUNK_INDEX + self._channels * _CHUNK_INDEX_ENTRY

    def bound(self, more: int = 0) -> int:
        """Return a length that the finished file does not pass, with ``more`` bytes of data."""
        chunk = self._chunk + more + _MESSAGE + _MESSAGE_INDEX_ENTRY
        # The bound that zstd gives for data that can't be compressed.
        compressed = chunk + chunk // 256 + 64 + _CHUNK
        next_index = _CHUNK_INDEX + self._channels * _CHUNK_INDEX_ENTRY
        return self._position + compressed + next_index + self._summary
