# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Figures of a snapshot that follow from others."""

import math

from cloth_sim_ros.sim.snapshot import FLAG_GAP
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from cloth_sim_ros.sim.snapshot import present_cells
from made_snapshot import make_snapshot
import numpy as np
import pytest


@pytest.mark.parametrize(('bound', 'ratio'), [
    (0.1, 1.25), (0.25, 0.5), (0.0, 0.0), (math.inf, 0.0)])
def test_strain_over_bound(bound, ratio):
    """A mode without a limit would be reported as far beyond one, or end in a division by 0."""
    snapshot = make_snapshot(2, 2, max_strain=0.125, strain_bound=bound)
    assert snapshot.strain_over_bound == ratio


def test_strain_over_bound_of_a_blown_up_cloth():
    """It would be reported as within its limit."""
    assert math.isnan(make_snapshot(2, 2, max_strain=math.nan, strain_bound=0.1).strain_over_bound)


def test_limit_figures_are_0_unless_reported():
    """A mode that makes no such substeps would have to report them."""
    snapshot = make_snapshot(2, 2)
    assert [getattr(snapshot, name) for name in (
        'calm_substeps', 'listed_substeps', 'whole_substeps', 'listed_edges', 'limit_rounds',
        'limit_unreached')] == [0] * 6


def test_cells_are_there_without_the_flag_of_a_gap():
    """A pinned node would have no cell, or the last row and column one too many."""
    flags = np.array([[FLAG_PINNED, FLAG_GAP, 0], [0, FLAG_GAP | FLAG_PINNED, 0], [0, 0, 0]])
    assert present_cells(flags).tolist() == [[True, False], [True, False]]
    assert present_cells(flags[:1]).shape == (0, 2)
