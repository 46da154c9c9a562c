# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""What the records of an mcap file have said of its topics so far."""

from collections.abc import Collection
from collections.abc import Mapping

from cloth_sim_ros.recording.bag_topic import BagTopic
from cloth_sim_ros.recording.recorded_qos import recorded_qos
from mcap.records import Channel
from mcap.records import McapRecord
from mcap.records import Schema
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import MessageDefinitionFormat

_FORMATS = {'ros2msg': MessageDefinitionFormat.MSG, 'ros2idl': MessageDefinitionFormat.IDL}


class McapChannels:
    """The channels of an mcap file by their number, with the schemas they name."""

    def __init__(self) -> None:
        """Begin with none."""
        self._schemas: dict[int, Schema] = {}
        self._channels: dict[int, Channel] = {}

    def read(self, record: McapRecord) -> None:
        """Take up a schema or a channel; any other record is passed over."""
        if isinstance(record, Schema):
            self._schemas[record.id] = record
        elif isinstance(record, Channel):
            self._channels[record.id] = record

    def __contains__(self, number: int) -> bool:
        """Tell whether the channel ``number`` is known."""
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
