# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Read YAML that may be hostile: of bounded depth and size, and each key once."""

from collections.abc import Generator
from collections.abc import Iterator
from contextlib import closing
import math
from pathlib import Path
import re
from typing import Any
from typing import cast

from cloth_sim_ros.files.errors import ClothSimError
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.files.regular_file import read_regular
import yaml

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
    """Return whether a collection of ``kind``, seq or map, may have ``tag``."""
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
        # A leading 0 means octal if all digits allow it.
        return float(text) if set(digits) & set('89') else sign * int(digits, 8)
    return int(text)


MOST_BYTES = 4 << 20
MOST_DEPTH = 32
MOST_VALUES = 300_000  # with what aliases stand for

# Ten times as fast, where PyYAML was built with libyaml.
_LOADER = getattr(yaml, 'CSafeLoader', yaml.SafeLoader)
_NO_KEY = object()


def load_yaml(path: str | Path) -> Any:
    """Return what the YAML file at ``path`` holds; ClothSimError when it can't be read."""
    try:
        content = read_regular(path, MOST_BYTES)
    except OSError as error:
        raise ClothSimError(
            f'{cut(path)} cannot be read: {error.strerror}: give a file that exists and is '
            'readable') from error
    try:
        return parse_yaml(content.decode(), cut(path))
    except UnicodeDecodeError as error:
        raise ClothSimError(
            f'{cut(path)} is not valid YAML: byte {error.start} is not UTF-8: save it as '
            'UTF-8') from error


def parse_yaml(text: str, name: str) -> Any:
    """
    Return the value of ``text``.

    Types are those of ROS parameters. The parser works through the text without recursion, so
    that the limits hold before any depth or size can do harm.

    :param name: what the text is, for errors
    :raises ClothSimError: when it is no YAML, beyond MOST_DEPTH or MOST_VALUES, or has a key twice
    """
    try:
        # The type stubs declare an iterator; it is a generator.
        parsed = cast(Generator[yaml.Event, None, None], yaml.parse(text, Loader=_LOADER))
        with closing(parsed) as events:
            return _Document().read(events)
    except _Refused as error:
        raise ClothSimError(f'{name} has {error}') from error
    except yaml.YAMLError as error:
        raise ClothSimError(f'{name} is not valid YAML: {_reason(error)}') from error
    except UnicodeEncodeError as error:
        raise ClothSimError(
            f'{name} is not valid YAML: character {error.start} is not text: save it as UTF-8'
        ) from error


class _Refused(ValueError):
    """Valid YAML that is refused."""


class _Collection:
    """A list or a mapping that has begun and has not ended."""

    def __init__(self, value: list[Any] | dict[Any, Any], event: yaml.NodeEvent) -> None:
        self.value = value
        self.anchor = event.anchor
        self.line = _line(event)
        self.key: Any = _NO_KEY
        self.size = 1
        self.height = 1

    def take(self, value: Any, size: int, height: int, line: int) -> None:
        """Put in the next value, which stands for ``size`` values and is ``height`` deep."""
        self.size += size
        self.height = max(self.height, 1 + height)
        if isinstance(self.value, list):
            self.value.append(value)
        elif self.key is _NO_KEY:
            if isinstance(value, (list, dict)):
                raise _Refused(f'a list or a mapping as a key in line {line}: give a name')
            if value in self.value:
                raise _Refused(f'the key {cut(value)} twice, again in line {line}: keep one')
            self.key = value
        else:
            self.value[self.key] = value
            self.key = _NO_KEY


class _Document:
    """Makes the value of the one document in a stream of events."""

    def __init__(self) -> None:
        self._open: list[_Collection] = []
        self._anchors: dict[str, tuple[Any, int, int]] = {}
        self._value: Any = None
        self._count = 0
        self._documents = 0

    def read(self, events: Iterator[yaml.Event]) -> Any:
        """Return the value; None for an empty document."""
        for event in events:
            if isinstance(event, yaml.ScalarEvent):
                self._put(_scalar(event), 1, 0, event)
            elif isinstance(event, yaml.SequenceStartEvent):
                self._begin([], 'seq', event)
            elif isinstance(event, yaml.MappingStartEvent):
                self._begin({}, 'map', event)
            elif isinstance(event, yaml.CollectionEndEvent):
                self._end()
            elif isinstance(event, yaml.AliasEvent):
                self._repeat(event)
            elif isinstance(event, yaml.DocumentStartEvent):
                self._documents += 1
                if self._documents > 1:
                    raise _Refused(
                        f'a second document in line {_line(event)}: keep one in the file')
        return self._value

    def _begin(
            self, value: list[Any] | dict[Any, Any], kind: str,
            event: yaml.CollectionStartEvent) -> None:
        if not is_collection_tag(event.tag, kind):
            raise _Refused(
                f'the tag {cut(event.tag, 64)} in line {_line(event)}, for which ROS has no type: '
                'remove it')
        self._open.append(_Collection(value, event))
        self._check_depth(0, event)
        self._add(1, event)

    def _end(self) -> None:
        ended = self._open.pop()
        if ended.anchor is not None:
            self._anchors[ended.anchor] = ended.value, ended.size, ended.height
        self._place(ended.value, ended.size, ended.height, ended.line)

    def _repeat(self, event: yaml.AliasEvent) -> None:
        name = cut(event.anchor, 64)
        if any(each.anchor == event.anchor for each in self._open):
            raise _Refused(f'*{name} within &{name} in line {_line(event)}: remove one')
        if event.anchor not in self._anchors:
            raise _Refused(f'*{name} without &{name} before it in line {_line(event)}: add it')
        value, size, height = self._anchors[event.anchor]
        self._check_depth(height, event)
        self._put(value, size, height, event)

    def _put(self, value: Any, size: int, height: int, event: yaml.NodeEvent) -> None:
        self._add(size, event)
        if event.anchor is not None and not isinstance(event, yaml.AliasEvent):
            self._anchors[event.anchor] = value, size, height
        self._place(value, size, height, _line(event))

    def _place(self, value: Any, size: int, height: int, line: int) -> None:
        if self._open:
            self._open[-1].take(value, size, height, line)
        else:
            self._value = value

    def _add(self, size: int, event: yaml.NodeEvent) -> None:
        self._count += size
        if self._count > MOST_VALUES:
            raise _Refused(
                f'more than {MOST_VALUES} values, with aliases expanded, in line {_line(event)}: '
                'remove some')

    def _check_depth(self, height: int, event: yaml.NodeEvent) -> None:
        if len(self._open) + height > MOST_DEPTH:
            raise _Refused(
                f'more than {MOST_DEPTH} nested lists and mappings in line {_line(event)}: '
                'flatten it')


def _scalar(event: yaml.ScalarEvent) -> Any:
    try:
        if event.tag is not None:
            return tagged_value(event.value, event.tag)
        return plain_value(event.value) if event.implicit[0] else event.value
    except ValueError as error:
        raise _Refused(f'{error}, in line {_line(event)}: rewrite it') from error


def _line(event: yaml.Event) -> int:
    mark = event.start_mark
    assert mark is not None  # the parser marks what it reads
    return mark.line + 1


def _reason(error: yaml.YAMLError) -> str:
    if isinstance(error, yaml.MarkedYAMLError) and error.problem_mark is not None:
        problem = error.problem or error.context or 'a mistake'
        return f'{cut(problem)} in line {error.problem_mark.line + 1}'
    return cut(error)
