# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The topics of a bag and their messages, decoded by the definitions that the bag holds."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
import re
from typing import Any
from typing import cast
from typing import NamedTuple

from cloth_sim_ros.files.checked_yaml import parse_yaml
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.recording.cdr_check import CdrCheck
from cloth_sim_ros.sim.errors import ClothSimError
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import MessageDefinitionFormat
from rosbags.interfaces import Nodetype
from rosbags.interfaces import Qos
from rosbags.interfaces.typing import Typesdict
from rosbags.rosbag2.metadata import parse_qos
from rosbags.serde import SerdeError
from rosbags.typesys import get_types_from_idl
from rosbags.typesys import get_types_from_msg
from rosbags.typesys import get_typestore
from rosbags.typesys import Stores
from rosbags.typesys.store import Typestore

_MOST_DEPTH = 1_000_000
_MOST_PROFILES = 1000


def recorded_qos(text: object) -> tuple[Qos, ...]:
    """Return the profiles in the YAML ``text``; none where it is no text, or of another form."""
    if not text or not isinstance(text, str):
        return ()
    try:
        profiles = tuple(parse_qos(parse_yaml(text, 'offered_qos_profiles')[:_MOST_PROFILES]))
    except Exception:  # of another writer, in another form: nothing is read by it
        return ()
    are_right = all(
        type(profile.depth) is int and 0 <= profile.depth <= _MOST_DEPTH for profile in profiles)
    return profiles if are_right else ()


def qos_profiles(text: object) -> list[dict[str, Any]]:
    """Return the profiles in the YAML ``text`` as metadata.yaml of version 9 has them."""
    return [{
        'history': profile.history.name.lower(),
        'depth': profile.depth,
        'reliability': profile.reliability.name.lower(),
        'durability': profile.durability.name.lower(),
        'deadline': profile.deadline._asdict(),
        'lifespan': profile.lifespan._asdict(),
        'liveliness': profile.liveliness.name.lower(),
        'liveliness_lease_duration': profile.liveliness_lease_duration._asdict(),
        'avoid_ros_namespace_conventions': profile.avoid_ros_namespace_conventions,
    } for profile in recorded_qos(text)]


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


# Message definitions of a bag, parsed: they can be hostile as well.

MOST_CHARACTERS = 200_000
# Code is written for each element of an array of fixed length, but of numbers.
MOST_ELEMENTS = 2000
MOST_MODULES = 8

_IDL_RULE = '=' * 80 + '\n'
_IDL_PROSE = re.compile(r'"(?:\\.|[^"\\])*"|//[^\n]*|/\*.*?\*/', re.DOTALL)
_IDL_ANNOTATION = re.compile(r'@[\w:]+\s*\([^()]*\)')
# The parser tries each of these in many ways, in one another in all combinations.
_IDL_NESTED = re.compile(r'[()|^&]|<<|>>|<[^<>]*<[^<>]*<')


def parse_definition(definition: MessageDefinition, name: str) -> Typesdict:
    """
    Return the types of ``definition``, which is that of the type ``name``.

    :raises ValueError: when parsing it, or reading messages by it, could take forever
    :raises Exception: of other kinds, when it makes no sense
    """
    text = definition.data
    if len(text) > MOST_CHARACTERS:
        raise ValueError(
            f'its definition has {len(text)} characters, the maximum is {MOST_CHARACTERS}')
    types = (
        get_types_from_msg(text, name) if definition.format is MessageDefinitionFormat.MSG
        else _idl_types(text))
    _check_arrays(types)
    return types


def _idl_types(text: str) -> Typesdict:
    parts = [text]
    if text.startswith(f'{_IDL_RULE}IDL: '):
        parts = [part.partition('\n')[2] for part in text.split(_IDL_RULE)[1:]]
    types: Typesdict = {}
    for part in parts:
        code = _IDL_ANNOTATION.sub(' ', _IDL_PROSE.sub(' ', part))
        nested = _IDL_NESTED.search(code)
        if nested or code.count('module') > MOST_MODULES:
            raise ValueError(
                f'its definition has {shown(nested.group()[:20])}, an expression' if nested
                else f'its definition has more than {MOST_MODULES} modules')
        types.update(get_types_from_idl(part))
    return types


def _check_arrays(types: Typesdict) -> None:
    """Raise ValueError for arrays that are too long to write code for, or take no byte."""
    elements = 0
    for name, (_, fields) in types.items():
        for field, (kind, parts) in fields:
            if kind != Nodetype.ARRAY:
                continue
            # The types of rosbags leave open which kind has which parts.
            (element, described), length = cast(
                tuple[tuple[Nodetype, tuple[str, int]], int], parts)
            if length < 1:
                # Nested, arrays of such would be walked through forever within a few bytes.
                raise ValueError(f'{field} of {name} is an array of length {length}')
            if element != Nodetype.BASE or described[0] == 'string':
                elements += length
    if elements > MOST_ELEMENTS:
        raise ValueError(
            f'its arrays of fixed length have {elements} elements, the maximum is {MOST_ELEMENTS}')


# Decoding of CDR by the definitions in a bag.

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
        self._checks: dict[str, CdrCheck | None] = {}

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

    def problem(self, message: RawMessage) -> str:
        """Return what is wrong with the lengths within a message; empty for nothing."""
        check = self.check_of(message.type_name)
        try:
            if check is not None:
                check.check(message.data)
        except ValueError as error:
            return str(error)
        return ''

    def check_of(self, name: str) -> CdrCheck | None:
        """Return what checks messages of the type ``name``; None where nothing is known of it."""
        if name not in self._checks:
            try:
                self._checks[name] = CdrCheck(self._store(name), name)
            except Exception:  # what foreign text raises can be anything
                self._checks[name] = None
        return self._checks[name]

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
