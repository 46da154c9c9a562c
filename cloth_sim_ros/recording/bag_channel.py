# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a bag states of a topic: its type, the definition of that, and its quality of service."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

# Of a channel and of its schema, besides their texts.
_RECORD_BYTES = 128


@dataclass(frozen=True)
class BagChannel:
    """
    A topic as it is written into mcap files and metadata.yaml.

    :param name: in the graph
    :param type_name: such as std_msgs/msg/Header
    :param definition_encoding: ros2msg or ros2idl
    :param definition: text of the type and of all it is made of
    :param metadata: of the channel in mcap files
    :param qos: profiles that were offered, as in metadata.yaml of version 9
    :param type_hash: that publishers of the type announce; empty where it is not known
    :param transient_local: True where late subscribers get the last message
    """

    name: str
    type_name: str
    definition_encoding: str
    definition: bytes
    metadata: Mapping[str, str]
    qos: list[dict[str, Any]]
    type_hash: str
    transient_local: bool = False
    message_encoding: str = 'cdr'

    @property
    def key(self) -> tuple[str, str]:
        """Return name and type: a bag can have one name with several types."""
        return self.name, self.type_name

    @property
    def length(self) -> int:
        """Get a bound of the length of its records in an mcap file [bytes]."""
        texts = (self.name, self.type_name, *self.metadata.keys(), *self.metadata.values())
        return _RECORD_BYTES + len(self.definition) + sum(len(text.encode()) for text in texts)
