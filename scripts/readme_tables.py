#!/usr/bin/env python3
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


"""
Write the parameter tables of README.md from the field tables of the code.

    python scripts/readme_tables.py          writes them
    python scripts/readme_tables.py --check  exits with 1 when README.md has others
"""

from collections.abc import Iterable
from pathlib import Path
import sys

from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.sim.field import Field
from cloth_sim_ros.sim.scene_fields import SCENE_FIELDS

README = Path(__file__).resolve().parents[1] / 'README.md'
TABLES = {'scene parameters': SCENE_FIELDS, 'node parameters': NODE_FIELDS}
_WORDS = {bool: 'bool', int: 'int', float: 'float', str: 'string'}


def with_tables(text: str) -> str:
    """Return ``text`` with the present tables between their marks."""
    for name, fields in TABLES.items():
        begin, end = f'<!-- {name} -->\n', f'<!-- end of {name} -->'
        before, _, rest = text.partition(begin)
        _, _, after = rest.partition(end)
        text = f'{before}{begin}{table(fields)}{end}{after}'
    return text


def table(fields: Iterable[Field]) -> str:
    """Return the Markdown table of ``fields``."""
    lines = ['| name | type | default | range | what it is |', '|---|---|---|---|---|']
    lines += [f'| {" | ".join(cells(field))} |' for field in fields]
    return '\n'.join(lines) + '\n'


def cells(field: Field) -> list[str]:
    """Return the cells of one parameter."""
    unit = f' [{field.unit}]' if field.unit else ''
    live = '; can be changed while the node runs' if field.live else ''
    return [
        f'`{field.name}`',
        _WORDS[field.kind] + ('[]' if field.is_array else ''),
        f'`{value(field.default)}`',
        range_of(field),
        f'{field.text}{unit}{live}']


def range_of(field: Field) -> str:
    """Return the values that are allowed."""
    if field.choices:
        return ', '.join(f'`{choice}`' for choice in field.choices)
    if field.low is None or field.high is None:
        return ''
    if field.kind is int:
        return f'{field.low} to {field.high}'
    return f'{field.low:g} to {field.high:g}'


def value(default: object) -> str:
    """Return a default as one writes it in YAML."""
    if isinstance(default, tuple):
        return f'[{", ".join(value(part) for part in default)}]'
    if isinstance(default, bool):
        return str(default).lower()
    return str(default) if default != '' else "''"


def main() -> int:
    """Write or check README.md."""
    old = README.read_text(encoding='utf-8')
    new = with_tables(old)
    if new == old:
        return 0
    if sys.argv[1:] == ['--check']:
        print('README.md is behind: run python scripts/readme_tables.py', file=sys.stderr)
        return 1
    README.write_text(new, encoding='utf-8')
    return 0


if __name__ == '__main__':
    sys.exit(main())
