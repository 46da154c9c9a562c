# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The page that a run of the suite leaves: a table for each kind of row of each section."""

from collections.abc import Iterator
from collections.abc import Mapping
from collections.abc import Sequence
from typing import Any

from gpu.section import Outcome
from gpu.section import Row


def page(head: Mapping[str, Any], outcomes: Sequence[Outcome]) -> str:
    """
    Return the page as Markdown.

    :param head: device, versions and commit
    """
    return '\n'.join(_lines(head, outcomes)) + '\n'


def _lines(head: Mapping[str, Any], outcomes: Sequence[Outcome]) -> Iterator[str]:
    yield f'# {head.get("device", "no device")}'
    yield ''
    yield '    python benchmarks/gpu_suite.py'
    yield ''
    for name, value in head.items():
        yield f'- {name}: {value}'
    for outcome in outcomes:
        yield ''
        yield f'## {outcome.title}'
        yield ''
        yield f'`{outcome.name}`: {outcome.status}, {outcome.seconds:.0f} s'
        if outcome.error:
            yield ''
            yield '```text'
            yield outcome.error.strip()
            yield '```'
        for columns, rows in _by_columns(outcome.rows):
            yield ''
            yield f'| {" | ".join(columns)} |'
            yield f'|{"---|" * len(columns)}'
            for row in rows:
                yield f'| {" | ".join(_cell(row[name]) for name in columns)} |'


def _by_columns(rows: Sequence[Row]) -> Iterator[tuple[tuple[str, ...], list[Row]]]:
    """Yield the rows that have the same columns together, in the order of their first."""
    tables: dict[tuple[str, ...], list[Row]] = {}
    for row in rows:
        tables.setdefault(tuple(row), []).append(row)
    yield from tables.items()


def _cell(value: Any) -> str:
    if isinstance(value, bool):
        return 'yes' if value else 'no'
    if isinstance(value, int):
        return f'{value:,}'
    if isinstance(value, float):
        return f'{value:.4g}'
    return str(value).replace('|', '/').replace('\n', ' ')
