# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The figures of all frames of a recording, one row each, and its histogram of strain."""

from cloth_sim_ros.analysis.frame_table import COLUMNS
from cloth_sim_ros.analysis.frame_table import FrameTable
from cloth_sim_ros.analysis.frame_table import StrainHistogram
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


# Counting strains while they come.


def test_shares_are_those_of_all_strains():
    """The histogram would show another cloth, or one frame for all of them."""
    random = np.random.default_rng(3)
    frames = random.gamma(2.0, 0.02, (20, 30, 40)).astype(np.float32)
    histogram = StrainHistogram()
    for frame in frames:
        histogram.add(frame)
    edges = np.linspace(0.0, float(frames.max()) * (1.0 + 1e-6), 51)
    of_all, of_last = histogram.shares(edges)
    # A strain next to an edge may fall on its other side: bins are 0.3 % wide.
    np.testing.assert_allclose(
        of_all, np.histogram(frames, edges)[0] / frames.size, rtol=0.1, atol=2e-3)
    np.testing.assert_allclose(
        of_last, np.histogram(frames[-1], edges)[0] / frames[-1].size, rtol=0.1, atol=6e-3)
    assert abs(of_all.sum() - 1.0) < 1e-12 and abs(of_last.sum() - 1.0) < 1e-12


def test_strains_of_all_sizes_are_counted():
    """A cloth at rest, or one that blew up, would be left out."""
    strain = np.array([[0.0, 1e-30, 1e-8, 1e-3, 0.5, 60.0, np.inf, np.nan]], np.float32)
    histogram = StrainHistogram()
    histogram.add(strain)
    of_all, _ = histogram.shares(np.array([0.0, 5e-4, 0.1, 1.0, 1e9]))
    np.testing.assert_allclose(of_all, np.array([3, 1, 1, 3]) / 8)


def test_strains_of_a_column_are_counted():
    """The strain is one field of a point, not a row of numbers beside each other."""
    records = np.zeros((2, 3), [('x', np.float32), ('strain', np.float32)])
    records['strain'] = 0.25
    records['x'] = 7.0
    histogram = StrainHistogram()
    histogram.add(records['strain'])
    np.testing.assert_array_equal(histogram.shares(np.array([0.0, 0.2, 0.3, 9.0]))[0], [0, 1, 0])
