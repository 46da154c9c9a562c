# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A topic of a bag: its type and definition, and one of its messages as recorded."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any
from typing import NamedTuple

from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import Qos

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


@dataclass(frozen=True)
class BagTopic:
    """
    A topic of a bag.

    :param type_name: such as std_msgs/msg/Header
    :param qos: what its publishers offered; empty where the bag does not say
    :param count: of its messages; of a broken file, of those that can be read
    :param definition: of the type, as far as the bag holds it
    """

    name: str
    type_name: str
    qos: tuple[Qos, ...]
    count: int
    definition: MessageDefinition


class RawMessage(NamedTuple):
    """
    A message as it was recorded.

    :param topic: its full name
    :param time: at which it was recorded: simulated in this project's recordings, of the wall
        clock in those of `ros2 bag record` [ns]
    :param data: CDR, with its header of 4 bytes
    """

    topic: str
    type_name: str
    time: int
    data: bytes
