# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Put a shader together: its file, what it includes, and the choices made at compile time."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path
import re
from typing import NamedTuple

from cloth_sim_ros.gl.errors import ShaderError
from cloth_sim_ros.gl.shared_directory import shader_directory

VERSION_LINE = '#version 430 core'
_INCLUDE = re.compile(r'\s*#include\s+"([^"]+)"\s*$')
_WORD = re.compile(r'\w+')


class ShaderSource:
    """
    The text of a shader, ready for the compiler, that remembers where each line is from.

    :param name: file in the shader folder
    :param defines: what to #define, names and values
    """

    def __init__(self, name: str, defines: Mapping[str, object] | None = None) -> None:
        """Read the file and everything it includes, each once."""
        self.name = name
        self.defines = dict(defines or {})
        self._lines: list[str] = [VERSION_LINE]
        self._origins: list[str] = ['version']
        body = _expanded(shader_directory(), name)
        # Without those it does not use, one program serves scenes that differ in them.
        used = _used(self.defines, set(body.words))
        for key, value in self.defines.items():
            if key in used:
                self._append(f'#define {key} {value}', 'define')
        self._lines += (line for line, _ in body.lines)
        self._origins += (origin for _, origin in body.lines)

    @property
    def text(self) -> str:
        """Return the whole shader."""
        return '\n'.join(self._lines) + '\n'

    @property
    def used_defines(self) -> dict[str, object]:
        """Return those of the choices that the shader reads, names and values."""
        words = _expanded(shader_directory(), self.name).words
        return {key: value for key, value in self.defines.items() if _name(key) in words}

    def origin(self, line: int) -> str:
        """Return 'file:line' and the text of line ``line`` (from 1) of the whole."""
        if not 1 <= line <= len(self._lines):
            return f'line {line}'
        return f'{self._origins[line - 1]}: {self._lines[line - 1].strip()}'

    def _append(self, line: str, origin: str) -> None:
        self._lines.append(line)
        self._origins.append(origin)


def _used(defines: Mapping[str, object], words: set[str]) -> set[str]:
    """Return which of ``defines`` are among ``words``, or in what those stand for."""
    used: set[str] = set()
    while more := {key for key in defines if key not in used and _name(key) in words}:
        used |= more
        for key in more:
            words.update(_WORD.findall(str(defines[key])))
    return used


def _name(key: str) -> str:
    return key.partition('(')[0]


class _Text(NamedTuple):
    """
    A shader with all that it includes.

    :param lines: of them all, and where each is from
    :param words: in these
    """

    lines: list[tuple[str, str]]
    words: frozenset[str]


@cache
def _expanded(root: Path, name: str) -> _Text:
    lines: list[tuple[str, str]] = []
    seen: dict[str, frozenset[str]] = {}
    _expand(root, name, seen, lines)
    return _Text(lines, frozenset().union(*seen.values()))


def _expand(
        root: Path, name: str, seen: dict[str, frozenset[str]],
        lines: list[tuple[str, str]]) -> None:
    file = _file(root, name)
    seen[name] = file.words
    begin = 0
    for end, included in file.includes:
        lines += file.lines[begin:end]
        begin = end
        if included not in seen:
            _expand(root, included, seen, lines)
    lines += file.lines[begin:]


class _File(NamedTuple):
    """
    A file of the shader folder.

    :param lines: but for includes, and where each is from
    :param includes: before which of these each stands, and its name
    :param words: of the lines
    """

    lines: list[tuple[str, str]]
    includes: list[tuple[int, str]]
    words: frozenset[str]


# Most files are included by many others.
@cache
def _file(root: Path, name: str) -> _File:
    lines: list[tuple[str, str]] = []
    includes: list[tuple[int, str]] = []
    for number, line in enumerate(_text(root, name).splitlines(), 1):
        include = _INCLUDE.match(line)
        if include:
            includes.append((len(lines), include[1]))
        # The version stands once, on top; a file keeps its own for tools that read it alone.
        elif not line.startswith('#version'):
            lines.append((line, f'{name}:{number}'))
    words = _WORD.findall('\n'.join(line for line, _ in lines))
    return _File(lines, includes, frozenset(words))


def _text(root: Path, name: str) -> str:
    for path in (root / name, root / 'include' / name):
        if path.is_file():
            return path.read_text(encoding='utf-8')
    raise ShaderError(f'there is no shader {name} in {root}')
