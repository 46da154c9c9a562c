#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Run the notebook of the tutorial, keep what it shows in it, and write it as a page of docs.

    python scripts/notebook_page.py             runs it, and writes notebook, page and figures
    python scripts/notebook_page.py --out DIR   writes them to DIR instead
    python scripts/notebook_page.py --check     exits with 1 when the page is not the notebook's

It needs neither Jupyter nor a kernel: a cell is Python that prints and draws with pyplot.
"""

from argparse import ArgumentParser
import base64
from contextlib import redirect_stdout
from io import BytesIO
from io import StringIO
import json
from pathlib import Path
import sys
from typing import Any

import matplotlib

NOTEBOOK = Path(__file__).resolve().parents[1] / 'docs' / 'tutorial' / 'python_notebook.ipynb'
NOTE = '<!-- Written by scripts/notebook_page.py from {name}: edit that. -->\n\n'
DPI = 90


def run(notebook: dict[str, Any]) -> None:
    """Run the cells in order, and put what each prints and draws into it."""
    matplotlib.use('agg')
    from matplotlib import pyplot
    names: dict[str, Any] = {}
    count = 0
    for cell in notebook['cells']:
        if cell['cell_type'] != 'code':
            continue
        count += 1
        printed = StringIO()
        with redirect_stdout(printed):
            exec(compile(''.join(cell['source']), f'cell {count}', 'exec'), names)
        cell['execution_count'] = count
        cell['outputs'] = [*_text(printed.getvalue())]
        for number in pyplot.get_fignums():
            cell['outputs'].append(_picture(pyplot.figure(number)))
        pyplot.close('all')


def _text(printed: str) -> list[dict[str, Any]]:
    return [{
        'output_type': 'stream', 'name': 'stdout', 'text': printed.splitlines(keepends=True),
    }] if printed else []


def _picture(figure: Any) -> dict[str, Any]:
    file = BytesIO()
    figure.savefig(file, format='png', dpi=DPI)
    return {
        'output_type': 'display_data', 'metadata': {},
        'data': {
            'image/png': base64.b64encode(file.getvalue()).decode(),
            'text/plain': ['<Figure>']}}


def page_of(notebook: dict[str, Any], name: str) -> tuple[str, dict[str, bytes]]:
    """
    Return the page that shows ``notebook``, and its pictures by file name.

    :param name: of the notebook's file, without its ending
    """
    parts: list[str] = []
    pictures: dict[str, bytes] = {}
    for cell in notebook['cells']:
        source = ''.join(cell['source'])
        if cell['cell_type'] == 'markdown':
            parts.append(source)
            continue
        parts.append(f'```python\n{source}\n```')
        for output in cell['outputs']:
            if output['output_type'] == 'stream':
                text = ''.join(output['text']).rstrip('\n')
                parts.append(f'The cell prints:\n\n```text\n{text}\n```')
            else:
                picture = f'{name}_{len(pictures) + 1}.png'
                pictures[picture] = base64.b64decode(output['data']['image/png'])
                parts.append(f'![What the cell draws]({picture})')
    return NOTE.format(name=f'{name}.ipynb') + '\n\n'.join(parts) + '\n', pictures


def main() -> int:
    """Write notebook, page and pictures, or compare the last two with the notebook."""
    parser = ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--out', type=Path, default=NOTEBOOK.parent, help='folder to write to')
    parser.add_argument('--check', action='store_true', help='compare, run and write nothing')
    args = parser.parse_args()
    notebook = json.loads(NOTEBOOK.read_text(encoding='utf-8'))
    if not args.check:
        run(notebook)
    page, pictures = page_of(notebook, NOTEBOOK.stem)
    files = {NOTEBOOK.with_suffix('.md').name: page.encode(), **pictures}
    if args.check:
        stale = [name for name, content in files.items()
                 if not (args.out / name).is_file() or (args.out / name).read_bytes() != content]
        for name in stale:
            print(f'{name} is not what {NOTEBOOK.name} shows: run scripts/notebook_page.py',
                  file=sys.stderr)
        return int(bool(stale))
    text = json.dumps(notebook, indent=1, ensure_ascii=False) + '\n'
    for name, content in {NOTEBOOK.name: text.encode(), **files}.items():
        (args.out / name).write_bytes(content)
    return 0


if __name__ == '__main__':
    sys.exit(main())
