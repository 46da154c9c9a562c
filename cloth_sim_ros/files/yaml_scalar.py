# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The value of a YAML scalar, by the types that ROS parameters have."""

import math
import re
from typing import Any

from cloth_sim_ros.files.echo import shown

MOST_DIGITS = 64

_TAG = 'tag:yaml.org,2002:'
_NULLS = frozenset(('', '~', 'null', 'Null', 'NULL'))
_BOOLS = {
    word: value
    for value, words in ((True, ('yes', 'true', 'on')), (False, ('no', 'false', 'off')))
    for each in words for word in (each, each.capitalize(), each.upper())}
_INT = re.compile(r'[-+]?(?:0b[01]+|0x[0-9a-fA-F]+|[0-9]+)')
_FLOAT = re.compile(r'[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?')
_SPECIAL = {
    **dict.fromkeys(('.inf', '.Inf', '.INF', '+.inf', '+.Inf', '+.INF'), math.inf),
    **dict.fromkeys(('-.inf', '-.Inf', '-.INF'), -math.inf),
    **dict.fromkeys(('.nan', '.NaN', '.NAN'), math.nan)}


def plain_value(text: str) -> Any:
    """
    Return the value of ``text`` as it stands, without quotes or tag.

    Dates, numbers in base 60 and with underscores are words, as they are to ROS.

    :raises ValueError: for a number of more than MOST_DIGITS characters
    """
    if text in _NULLS:
        return None
    if text in _BOOLS:
        return _BOOLS[text]
    if text in _SPECIAL:
        return _SPECIAL[text]
    if not _FLOAT.fullmatch(text) and not _INT.fullmatch(text):
        return text
    if len(text) > MOST_DIGITS:
        raise ValueError(f'a number of {len(text)} characters, the maximum is {MOST_DIGITS}')
    return _number(text)


def tagged_value(text: str, tag: str) -> Any:
    """
    Return the value of ``text`` behind an explicit ``tag``.

    :raises ValueError: when it has none of that type, or the type is none of ROS
    """
    kind = tag.removeprefix(_TAG)
    if tag == '!' or kind == 'str':
        return text
    value = plain_value(text)
    if kind == 'float' and type(value) is int:
        return float(value)
    if kind in _TYPES and type(value) is _TYPES[kind]:
        return value
    if kind in _TYPES:
        raise ValueError(f'{shown(text[:MOST_DIGITS])} where !!{kind} requires another type')
    raise ValueError(f'the tag {shown(tag[:MOST_DIGITS])}, for which ROS has no type')


def is_collection_tag(tag: str | None, kind: str) -> bool:
    """Tell whether a collection of ``kind``, seq or map, may have ``tag``."""
    return tag in (None, '!', f'{_TAG}{kind}')


_TYPES = {'int': int, 'float': float, 'bool': bool, 'null': type(None)}


def _number(text: str) -> int | float:
    sign = -1 if text[0] == '-' else 1
    digits = text.lstrip('+-')
    if not _INT.fullmatch(digits):
        return float(text)
    if digits[:2] in ('0x', '0b'):
        return sign * int(digits, 0)
    if digits[0] == '0' and digits != '0':
        # What begins with 0 is octal, if it can be.
        return float(text) if set(digits) & set('89') else sign * int(digits, 8)
    return int(text)
