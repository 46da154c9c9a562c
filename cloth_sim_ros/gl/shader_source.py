# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Put a shader together: its file, what it includes, and the choices made at compile time."""

from collections.abc import Iterator
from collections.abc import Mapping
from functools import cache
from pathlib import Path
import re

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
        used = _used(self.defines, set(_words(shader_directory(), name)))
        for key, value in self.defines.items():
            if key in used:
                self._append(f'#define {key} {value}', 'define')
        self._lines += (line for line, _ in body)
        self._origins += (origin for _, origin in body)

    @property
    def text(self) -> str:
        """Return the whole shader."""
        return '\n'.join(self._lines) + '\n'

    @property
    def used_defines(self) -> dict[str, object]:
        """Return those of the choices that the shader reads, names and values."""
        words = _words(shader_directory(), self.name)
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


@cache
def _words(root: Path, name: str) -> frozenset[str]:
    """Return the words of a file and of all that it includes."""
    return frozenset(
        word for line, _ in _expanded(root, name) for word in _WORD.findall(line))


@cache
def _expanded(root: Path, name: str) -> tuple[tuple[str, str], ...]:
    """Return the lines of a file and of all that it includes, and where each is from."""
    return tuple(_lines(root, name, set()))


def _lines(root: Path, name: str, seen: set[str]) -> Iterator[tuple[str, str]]:
    seen.add(name)
    text = _locate(root, name).read_text(encoding='utf-8')
    for number, line in enumerate(text.splitlines(), 1):
        include = _INCLUDE.match(line)
        if include and include[1] not in seen:
            yield from _lines(root, include[1], seen)
        # The version stands once, on top; a file keeps its own for tools that read it alone.
        elif not include and not line.startswith('#version'):
            yield line, f'{name}:{number}'


def _locate(root: Path, name: str) -> Path:
    for path in (root / name, root / 'include' / name):
        if path.is_file():
            return path
    raise ShaderError(f'there is no shader {name} in {root}')
