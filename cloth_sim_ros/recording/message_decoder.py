# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""From CDR to messages, by the definitions that a bag holds."""

from collections.abc import Iterable
from functools import lru_cache
from typing import Any

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.recording.bag_topic import BagTopic
from cloth_sim_ros.recording.bag_topic import RawMessage
from cloth_sim_ros.recording.checked_definition import parse_definition
from cloth_sim_ros.sim.errors import ClothSimError
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import MessageDefinitionFormat
from rosbags.serde import SerdeError
from rosbags.typesys import get_typestore
from rosbags.typesys import Stores
from rosbags.typesys.store import Typestore

_TOO_LONG = 'size mismatch'


class MessageDecoder:
    """
    Decodes messages of the types of ``topics``, each type by its own definition.

    Types without one are taken from this project's packages, or else from ROS 2 Jazzy.
    """

    def __init__(self, topics: Iterable[BagTopic]) -> None:
        """Keep the definitions; they are parsed when needed."""
        self._definitions: dict[str, MessageDefinition] = {}
        for topic in topics:
            if topic.definition.format is not MessageDefinitionFormat.NONE:
                self._definitions.setdefault(topic.type_name, topic.definition)
        self._stores: dict[str, Typestore] = {}

    def decode(self, message: RawMessage) -> Any:
        """Return the message; ClothSimError when its bytes or its definition make no sense."""
        name = message.type_name
        try:
            if name not in self._stores:
                self._stores[name] = self._store(name)
            return _decoded(self._stores[name], message.data, name)
        except Exception as error:  # what foreign text or a damaged byte raises can be anything
            raise ClothSimError(
                f'a message on {cut(message.topic)} is not a valid {cut(name)} '
                f'({cut(error) or type(error).__name__}): give a recording of a cloth_sim '
                'node') from error

    def _store(self, name: str) -> Typestore:
        if name in self._definitions:
            return _parsed_store(self._definitions[name], name)
        if name.startswith('cloth_sim_interfaces/'):
            # Only such a bag needs the packages of ROS to be read.
            from cloth_sim_ros.recording.message_definition import message_definition
            return _parsed_store(
                MessageDefinition(MessageDefinitionFormat.MSG, message_definition(name)), name)
        return get_typestore(Stores.ROS2_JAZZY)


def _decoded(store: Typestore, data: bytes | memoryview, name: str) -> Any:
    """Return the message at the beginning of ``data``."""
    try:
        return store.deserialize_cdr(data, name)
    except SerdeError as error:
        if _TOO_LONG not in str(error):
            raise
        # The middleware gives a message of nested lists more bytes than it fills, which rosbags
        # takes for a mistake: parameters would not be readable.
        definition = store.get_msgdef(name)
        decode = definition.deserialize_cdr_le if data[1] else definition.deserialize_cdr_be
        return decode(data[4:], 0, definition.cls, store)[0]


# Most bags have the same definitions, which take longer to parse than a small bag to read.
@lru_cache(maxsize=64)
def _parsed_store(definition: MessageDefinition, name: str) -> Typestore:
    store = get_typestore(Stores.EMPTY)
    store.register(parse_definition(definition, name))
    return store


def recorded_type_hash(type_name: str, definition: MessageDefinition) -> str:
    """Return the hash that publishers of a recorded type announced; empty when unknown."""
    if definition.format is MessageDefinitionFormat.NONE:
        return ''
    try:
        return _parsed_store(definition, type_name).hash_rihs01(type_name)
    except Exception:  # what foreign text raises can be anything
        return ''
