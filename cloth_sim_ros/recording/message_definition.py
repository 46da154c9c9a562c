# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a recording says about a message type, read and written; it can be hostile."""

from functools import cache
import json
import re

from cloth_sim_ros.files.echo import shown
from cloth_sim_ros.recording.share_folder import share_folder
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import MessageDefinitionFormat
from rosbags.interfaces import Nodetype
from rosbags.interfaces.typing import Typesdict
from rosbags.typesys import get_types_from_idl
from rosbags.typesys import get_types_from_msg

_PRIMITIVES = {
    'bool', 'byte', 'char', 'float32', 'float64', 'int8', 'uint8', 'int16', 'uint16', 'int32',
    'uint32', 'int64', 'uint64', 'string', 'wstring'}
_FIELD_TYPE = re.compile(r'^\s*([a-zA-Z0-9_/]+)', re.MULTILINE)
MOST_CHARACTERS = 200_000
# Code is written for each element of an array of fixed length, but of numbers.
MOST_ELEMENTS = 2000
MOST_MODULES = 8

_IDL_RULE = '=' * 80 + '\n'
_IDL_PROSE = re.compile(r'"(?:\\.|[^"\\])*"|//[^\n]*|/\*.*?\*/', re.DOTALL)
_IDL_ANNOTATION = re.compile(r'@[\w:]+\s*\([^()]*\)')
# The parser tries each of these in many ways, in one another in all combinations.
_IDL_NESTED = re.compile(r'[()|^&]|<<|>>|<[^<>]*<[^<>]*<')


@cache
def message_definition(type_name: str) -> str:
    """Return the text of ``type_name``, such as std_msgs/msg/Header, and of all it is made of."""
    package, name = _split(type_name)
    return _text_with_parts(package, name, set())


@cache
def type_hash(type_name: str) -> str:
    """Return the hash publishers of ``type_name`` announce."""
    package, name = _split(type_name)
    description = json.loads((share_folder(package) / 'msg' / f'{name}.json').read_text())
    return next(
        entry['hash_string'] for entry in description['type_hashes']
        if entry['type_name'] == f'{package}/msg/{name}')


def _split(type_name: str) -> tuple[str, str]:
    parts = type_name.split('/')
    return parts[0], parts[-1]


def _text_with_parts(package: str, name: str, seen: set[str]) -> str:
    """Return the text of one type, then of each type in it that is not in ``seen`` yet."""
    text = (share_folder(package) / 'msg' / f'{name}.msg').read_text()
    found = set(_FIELD_TYPE.findall(text)) - _PRIMITIVES
    result = text
    for part in sorted(part if '/' in part else f'{package}/{part}' for part in found):
        if part not in seen:
            seen.add(part)
            result += f'\n{"=" * 80}\nMSG: {part}\n' + _text_with_parts(*_split(part), seen)
    return result


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
            (element, described), length = parts
            if length < 1:
                # Nested, arrays of such would be walked through forever within a few bytes.
                raise ValueError(f'{field} of {name} is an array of length {length}')
            if element != Nodetype.BASE or described[0] == 'string':
                elements += length
    if elements > MOST_ELEMENTS:
        raise ValueError(
            f'its arrays of fixed length have {elements} elements, the maximum is {MOST_ELEMENTS}')
