# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Rows of figures from topics in any order."""

from cloth_sim_ros.analysis.frame_table import COLUMNS
from cloth_sim_ros.analysis.frame_table import FrameTable
import numpy as np


def test_topics_of_one_moment_share_a_row():
    """The figures of a frame would stand in two rows, each with half of them empty."""
    table = FrameTable()
    table.put(0, 0.02, {'total_energy': 2.0})
    table.put(0, 0.0, {'total_energy': 1.0})
    table.put(0, 0.02, {'mean_strain': 0.25})
    columns = table.columns()
    assert columns['time'].tolist() == [0.0, 0.02]
    assert columns['total_energy'].tolist() == [1.0, 2.0]
    assert np.isnan(columns['mean_strain'][0]) and columns['mean_strain'][1] == 0.25


def test_a_moment_before_and_one_after_a_reset_are_two():
    """The first frame after a reset would take the place of the last one before it."""
    table = FrameTable()
    table.put(0, 1.0, {'dt': 1.0})
    table.put(1, 1.0, {'dt': 2.0})
    assert table.columns()['dt'].tolist() == [1.0, 2.0]


def test_it_grows():
    """A long run would lose frames, or fail."""
    table = FrameTable()
    for number in range(5000):
        table.put(0, number / 8, dict.fromkeys(COLUMNS[2:], number))
    columns = table.columns()
    assert len(table) == 5000
    for name in COLUMNS[2:]:
        np.testing.assert_array_equal(columns[name], np.arange(5000))
