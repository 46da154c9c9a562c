# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The page of the Python API, from the signatures and docstrings of its names."""

from collections.abc import Iterator
import inspect
import re

import cloth_sim_ros

_FIELD = re.compile(r':(param|returns?|raises) ?(\w*): *')
_TITLES = {'param': '', 'return': 'Returns ', 'returns': 'Returns ', 'raises': 'Raises '}
# Module names in annotations are left out: the reader does not need them.
_MODULE = re.compile(r'\b(?:[a-z_]+\.)+(?=[A-Z])')
# A default that is a function: its address differs from run to run.
_FUNCTION = re.compile(r'<function (\w+) at 0x[0-9a-f]+>')


def python_page(note: str) -> str:
    """Return the page; ``note`` stands on top of it."""
    names = sorted(cloth_sim_ros.__all__, key=str.lower)
    kinds = [
        ('Classes', [name for name in names if not _is_error(name) and _is_class(name)]),
        ('Functions', [name for name in names if not _is_class(name)]),
        ('Errors', [name for name in names if _is_error(name)])]
    sections = '\n'.join(
        f'## {title}\n\n' + '\n'.join(_section(name) for name in members)
        for title, members in kinds)
    return f"""{note}
# Python API

`from cloth_sim_ros import NAME`. [Use the simulation from Python](../how_to/python_api.md) shows
them in use. Everything is in SI units, and z points up.

{sections}"""


def _is_class(name: str) -> bool:
    return inspect.isclass(getattr(cloth_sim_ros, name))


def _is_error(name: str) -> bool:
    return _is_class(name) and issubclass(getattr(cloth_sim_ros, name), Exception)


def _section(name: str) -> str:
    value = getattr(cloth_sim_ros, name)
    text = f'### {name}\n\n'
    if not _is_error(name):
        text += f'```text\n{_signature(name, value)}\n```\n\n'
    text += _markdown(value.__doc__)
    if _is_class(name):
        text += ''.join(_member(name, *member) for member in _members(value))
    return text


def _members(kind: type) -> Iterator[tuple[str, object]]:
    """Yield the public members that the class or a base of this project documents."""
    found: dict[str, object] = {}
    for base in reversed(kind.__mro__):
        if base.__module__.startswith('cloth_sim_ros'):
            found |= {
                name: value for name, value in vars(base).items()
                if not name.startswith('_') and _documentation(value)}
    yield from sorted(found.items())


def _documentation(value: object) -> str:
    if isinstance(value, property | classmethod | staticmethod) or inspect.isfunction(value):
        return inspect.getdoc(value) or ''
    return ''


def _member(owner: str, name: str, value: object) -> str:
    text = _markdown(_documentation(value))
    if isinstance(value, property):
        return f'\n#### {owner}.{name}\n\n{text}'
    function = value.__func__ if isinstance(value, classmethod | staticmethod) else value
    return f'\n#### {owner}.{name}\n\n```text\n{_signature(name, function)}\n```\n\n{text}'


def _signature(name: str, value: object) -> str:
    found = inspect.signature(value)
    kept = [each for each in found.parameters.values() if each.name not in ('self', 'cls')]
    parts = [_FUNCTION.sub(r'\1', _MODULE.sub('', str(each))) for each in kept]
    for index, each in enumerate(kept):
        if each.kind is each.KEYWORD_ONLY:
            if not any(one.kind is one.VAR_POSITIONAL for one in kept):
                parts.insert(index, '*')
            break
    end = ')'
    if found.return_annotation not in (found.empty, None, 'None') and not inspect.isclass(value):
        end = f') -> {_MODULE.sub("", _annotation(found.return_annotation))}'
    line = f'{name}({", ".join(parts)}{end}'
    if len(line) <= 95:
        return line
    return f'{name}(\n    ' + ',\n    '.join(parts) + end


def _annotation(value: object) -> str:
    return inspect.formatannotation(value) if not isinstance(value, str) else value


def _markdown(text: str | None) -> str:
    """Return a docstring in Markdown: its fields as a list."""
    lines = inspect.cleandoc(text or '').replace('``', '`').splitlines()
    out: list[str] = []
    for line in lines:
        field = _FIELD.match(line)
        if field:
            if out and out[-1] and not out[-1].startswith(('- ', '  ')):
                out.append('')
            name = f'`{field[2]}`: ' if field[2] else ''
            out.append(f'- {_TITLES[field[1]]}{name}{line[field.end():]}')
        elif line.startswith('    ') and out and out[-1].startswith(('- ', '  ')):
            out.append(f'  {line.strip()}')
        else:
            out.append(line)
    return '\n'.join(out).rstrip() + '\n'
