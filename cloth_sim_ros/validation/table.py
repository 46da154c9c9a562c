# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The validation table as Markdown, and what was measured for it."""

from collections.abc import Collection
from collections.abc import Iterator
from collections.abc import Sequence
from dataclasses import dataclass

from cloth_sim_ros.files.close_name import refuse_unknown
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.model.scene_fields import MODES
from cloth_sim_ros.validation.row import Figure
from cloth_sim_ros.validation.row import Row
from cloth_sim_ros.validation.rows import ROWS

# Between these lines a page holds the table.
BEGIN = '<!-- validation table: written by cloth_sim validate --long --out -->'
END = '<!-- end of the validation table -->'
_HEADER = (
    'row', 'what', 'formula or measurement', 'nodes', 'true', *MODES, 'allowed')


@dataclass(frozen=True)
class Measured:
    """
    A row on one grid.

    :param figures: by mode
    """

    row: Row
    nodes: int
    figures: dict[str, Figure]

    @property
    def failed(self) -> list[str]:
        """Return the modes that are off by more than is allowed."""
        return [mode for mode, figure in self.figures.items() if not self.row.holds(figure)]


def chosen(names: Collection[str], *, is_long: bool) -> list[Row]:
    """
    Return the rows to measure.

    :param names: of rows or families of them; empty for all, of which the long ones only if
        ``is_long``
    :raises ClothSimError: for a name that is none of them
    """
    if not names:
        return [row for row in ROWS if is_long or not row.is_long]
    known = [*(row.name for row in ROWS), *dict.fromkeys(
        row.name.partition('.')[0] for row in ROWS)]
    refuse_unknown('row', names, known)
    return [row for row in ROWS if {row.name, row.name.partition('.')[0]} & set(names)]


def measure(
        context: Context, rows: Sequence[Row],
        modes: Collection[str] = MODES) -> Iterator[Measured]:
    """Measure each row on each of its grids, in those of its modes that are requested."""
    for row in rows:
        asked = [mode for mode in MODES if mode in row.modes and mode in modes]
        for nodes in row.grids if asked else ():
            yield Measured(
                row, nodes, {mode: row.measure(context, mode, nodes) for mode in asked})


def markdown(found: Sequence[Measured]) -> str:
    """Return the table, and below it why each failure is one."""
    lines = [_HEADER, ('---',) * len(_HEADER), *map(_cells, found)]
    table = ''.join(f'| {" | ".join(line)} |\n' for line in lines)
    failures: dict[Row, list[str]] = {}
    for each in found:
        for mode in each.failed:
            failures.setdefault(each.row, []).append(f'{mode} on {each.nodes}')
    told = ''.join(
        f'- `{row.name}`, {", ".join(places)}: {row.shortfall or "not explained"}.\n'
        for row, places in failures.items())
    held = sum(len(each.figures) - len(each.failed) for each in found)
    total = sum(len(each.figures) for each in found)
    return (
        f'{table}\n{held} of {total} figures are within what is allowed.'
        + (f' Those in bold are not:\n\n{told}' if told else '\n'))


def _cells(each: Measured) -> tuple[str, ...]:
    row = each.row
    first = next(iter(each.figures.values()))
    return (
        f'`{row.name}`', row.what, row.truth, str(each.nodes), _true(row, first),
        *(_cell(each, mode) for mode in MODES), _allowed(row, first))


def _true(row: Row, figure: Figure) -> str:
    if figure.least == figure.most:
        return _in_unit(row, figure.most)
    return f'{_number(figure.least)} to {_in_unit(row, figure.most)}'


def _cell(each: Measured, mode: str) -> str:
    figure = each.figures.get(mode)
    if figure is None:
        return ''
    text = _number(figure.value)
    if figure.least == figure.most and figure.most:
        text += f' ({100.0 * (figure.value / figure.most - 1.0):+.2g} %)'
    return f'**{text}**' if mode in each.failed else text


def _allowed(row: Row, figure: Figure) -> str:
    if figure.least != figure.most:
        return 'the range'
    return f'{100.0 * row.allowed:g} %' if figure.most else f'up to {_in_unit(row, row.allowed)}'


def _number(value: float) -> str:
    return f'{value:.4g}'


def _in_unit(row: Row, value: float) -> str:
    return f'{_number(value)} {row.unit}'.strip()
