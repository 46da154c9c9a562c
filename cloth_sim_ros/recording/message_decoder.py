# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.


"""From CDR to messages, by the definitions that a bag holds."""

from collections.abc import Iterable
from typing import Any

from cloth_sim_ros.recording.bag_topic import BagTopic
from cloth_sim_ros.recording.bag_topic import RawMessage
from cloth_sim_ros.sim.errors import ClothSimError
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import MessageDefinitionFormat
from rosbags.interfaces.typing import Typesdict
from rosbags.typesys import get_types_from_idl
from rosbags.typesys import get_types_from_msg
from rosbags.typesys import get_typestore
from rosbags.typesys import Stores
from rosbags.typesys.store import Typestore

_IDL_RULE = '=' * 80 + '\n'


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
            return self._stores[name].deserialize_cdr(message.data, name)
        except Exception as error:  # what foreign text or a damaged byte raises can be anything
            raise ClothSimError(
                f'a message of {message.topic} is no {name} ({error or type(error).__name__}): '
                'give a recording of a cloth_sim node') from error

    def _store(self, name: str) -> Typestore:
        if name in self._definitions:
            return _typestore(_parsed(self._definitions[name], name))
        if name.startswith('cloth_sim_interfaces/'):
            # Only such a bag needs the packages of ROS to be read.
            from cloth_sim_ros.recording.message_definition import message_definition
            return _typestore(get_types_from_msg(message_definition(name), name))
        return get_typestore(Stores.ROS2_JAZZY)


def _typestore(types: Typesdict) -> Typestore:
    store = get_typestore(Stores.EMPTY)
    store.register(types)
    return store


def _parsed(definition: MessageDefinition, name: str) -> Typesdict:
    if definition.format is MessageDefinitionFormat.MSG:
        return get_types_from_msg(definition.data, name)
    types: Typesdict = {}
    if not definition.data.startswith(f'{_IDL_RULE}IDL: '):
        return get_types_from_idl(definition.data)
    for part in definition.data.split(_IDL_RULE)[1:]:
        types.update(get_types_from_idl(part.partition('\n')[2]))
    return types
