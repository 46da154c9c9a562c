# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Message definitions of a bag, parsed: they can be hostile as well."""

import re
from typing import cast

from cloth_sim_ros.files.errors import shown
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import MessageDefinitionFormat
from rosbags.interfaces import Nodetype
from rosbags.interfaces.typing import Typesdict
from rosbags.typesys import get_types_from_idl
from rosbags.typesys import get_types_from_msg

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
