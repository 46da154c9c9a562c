# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The scenes of the comparison hold what they should here, and begin alike elsewhere."""

from pathlib import Path

from comparison import box_row
from comparison import grip_row
from comparison import HEAVY
from comparison import LIGHT
from comparison import write
import numpy as np
from peers.gripped import CELL
from peers.gripped import hanging
from peers.gripped import level
from peers.gripped_here import PinchedHere
from peers.gripped_here import ThrownHere
from peers.gripped_mujoco import PinchedMuJoCo
from peers.gripped_mujoco import ThrownMuJoCo
import pytest


@pytest.mark.parametrize('mode', ['mass_spring', 'constraint'])
@pytest.mark.parametrize('grip', [LIGHT[0.5], HEAVY], ids=['light', 'heavy'])
def test_nothing_slips_here(mode, grip):
    """The page would say that a sheet is held which creeps."""
    cells = grip_row('a grip', mode, grip, lambda: PinchedHere(grip, mode)).split(' | ')
    print(cells)
    assert float(cells[2]) == pytest.approx(0.0, abs=0.1)
    assert abs(float(cells[3].split()[0])) < 0.5
    assert cells[4] == 'yes'


@pytest.mark.long
def test_the_box_gets_what_the_sheet_gives():
    """The forces that the page compares would not be those that stop the sheet."""
    cells = box_row('constraint', 12, lambda: ThrownHere(12, 'constraint')).split(' | ')
    print(cells)
    assert abs(float(cells[2])) < 1e-5
    assert float(cells[3]) == pytest.approx(1.0, rel=0.02)


def test_sheets_begin_alike():
    """The peer would be compared in another scene."""
    pytest.importorskip('mujoco', reason='needs `pip install mujoco`, which the peer is')
    np.testing.assert_allclose(
        PinchedMuJoCo(HEAVY, 1.0, 0).positions(), hanging(), atol=1e-6)
    np.testing.assert_allclose(ThrownMuJoCo(12).positions(), level(12), atol=1e-6)


def test_edges_begin_at_rest():
    """A sheet would be thrown out of its grip by its own springs."""
    assert np.linalg.norm(np.diff(hanging(), axis=0), axis=-1) == pytest.approx(CELL)


def test_a_page_without_a_place_is_refused(tmp_path: Path):
    """A table would be lost, or put over a page."""
    page = tmp_path / 'page.md'
    page.write_text('text\n', encoding='utf-8')
    with pytest.raises(SystemExit, match='lacks the lines'):
        write(page, 'grip', '| table |\n')
    assert page.read_text(encoding='utf-8') == 'text\n'
