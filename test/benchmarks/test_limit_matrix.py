# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the table of limits says of a run."""

from limit_matrix import row
from pushed_scenes import unit_scene
import pytest


@pytest.mark.parametrize('scheme', ['constraint', 'list', 'lattice', 'whole'])
def test_a_row_tells_strain_reports_and_energy(scheme):
    """A step beyond its limit would be missing, or what a push gives be counted as gain."""
    cells = row(unit_scene(
        8, 20.0, 0.02, **{'adaptive.threshold': 0.01, 'adaptive.scheme': scheme}), 1.3).split('|')
    assert 1.2 < float(cells[0]) < 2.5
    beyond, steps = map(int, cells[1].split(' of '))
    assert 0 < beyond < steps == 65
    assert int(cells[2]) == 0
    assert float(cells[3]) <= 1e-3
