# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The validation table and its verdicts, and the rows of the page that has it."""

from pathlib import Path

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.validation.row import exactly
from cloth_sim_ros.validation.row import Figure
from cloth_sim_ros.validation.row import Row
from cloth_sim_ros.validation.rows import ROWS
from cloth_sim_ros.validation.table import chosen
from cloth_sim_ros.validation.table import markdown
from cloth_sim_ros.validation.table import Measured
import pytest

PAGE = Path(__file__).parents[2] / 'docs' / 'validation.md'


def row(allowed: float = 0.01, shortfall: str = '') -> Row:
    """Return a row whose measurement nobody asks for."""
    return Row('a.b', 'a scene', 'a formula', 'm', allowed, lambda *_: exactly(1.0, 1.0), (3,),
               shortfall=shortfall)


@pytest.mark.parametrize(('figure', 'holds'), [
    (exactly(1.009, 1.0), True), (exactly(0.98, 1.0), False), (exactly(-1.02, -1.0), False),
    (exactly(float('nan'), 1.0), False), (exactly(float('inf'), 0.0), False),
    (exactly(0.009, 0.0), True), (exactly(0.02, 0.0), False), (Figure(20.0, 20.0, 40.0), True),
    (Figure(40.2, 20.0, 40.0), True), (Figure(19.0, 20.0, 40.0), False)])
def test_verdict(figure, holds):
    """A figure that is off, or no number, would pass."""
    assert row().holds(figure) is holds


def test_failures_are_told():
    """A failure would look like any other figure, or have no reason."""
    found = Measured(row(shortfall='known why'), 3, {
        'mass_spring': exactly(1.0, 1.0), 'constraint': exactly(1.5, 1.0)})
    text = markdown([found])
    assert '| 3 | 1 m | 1 (+0 %) | **1.5 (+50 %)** |  | 1 % |' in text
    assert '1 of 2 figures are within what is allowed.' in text
    assert '- `a.b`, constraint on 3: known why.' in text


def test_names_and_families():
    """A typing error would measure nothing, and be taken for success."""
    assert {each.name for each in chosen(['strips'], is_long=False)} == {
        each.name for each in ROWS if each.name.startswith('strips.')}
    assert [each.name for each in chosen(['drapes.denim'], is_long=False)] == ['drapes.denim']
    assert not any(each.is_long for each in chosen([], is_long=False))
    with pytest.raises(ClothSimError, match='did you mean strips'):
        chosen(['stripes'], is_long=False)


def test_the_page_has_every_row():
    """The page would lack a row or a grid, or show another tolerance than is held."""
    lines = [line.strip('|').split(' | ') for line in PAGE.read_text(
        encoding='utf-8').splitlines() if line.startswith('| `')]
    assert [(cells[0].strip(' `'), cells[3]) for cells in lines] == [
        (each.name, str(nodes)) for each in ROWS for nodes in each.grids]
    for cells in lines:
        each = next(one for one in ROWS if one.name == cells[0].strip(' `'))
        assert (cells[1], cells[2]) == (each.what, each.truth)


QUICK = [each for each in ROWS if not each.is_long]


@pytest.mark.parametrize(('one', 'mode'), [
    pytest.param(each, mode, id=f'{each.name}-{mode}', marks=[] if not each.name.startswith((
        'strips', 'loops', 'waves', 'air', 'friction.capstan')) else pytest.mark.long)
    for each in QUICK for mode in each.modes])
def test_quick_rows_hold(context, one, mode):
    """A row would be off by more than the page says, without a reason."""
    for nodes in one.grids:
        figure = one.measure(context, mode, nodes)
        print(f'measured {figure}, {one.allowed} allowed: {one.name}, {nodes} nodes')
        assert one.holds(figure) or one.shortfall
