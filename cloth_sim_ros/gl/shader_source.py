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
        for key, value in self.defines.items():
            self._append(f'#define {key} {value}', 'define')
        body = _expanded(shader_directory(), name)
        self._lines += (line for line, _ in body)
        self._origins += (origin for _, origin in body)

    @property
    def text(self) -> str:
        """Return the whole shader."""
        return '\n'.join(self._lines) + '\n'

    @property
    def used_defines(self) -> dict[str, object]:
        """Return those of the choices that the shader reads, names and values."""
        words = set(_WORD.findall('\n'.join(
            line for line, origin in zip(self._lines, self._origins) if origin != 'define')))
        return {key: value for key, value in self.defines.items()
                if key.partition('(')[0] in words}

    def origin(self, line: int) -> str:
        """Return 'file:line' and the text of line ``line`` (from 1) of the whole."""
        if not 1 <= line <= len(self._lines):
            return f'line {line}'
        return f'{self._origins[line - 1]}: {self._lines[line - 1].strip()}'

    def _append(self, line: str, origin: str) -> None:
        self._lines.append(line)
        self._origins.append(origin)


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
