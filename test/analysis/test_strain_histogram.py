# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Counting strains while they come."""

from cloth_sim_ros.analysis.strain_histogram import StrainHistogram
import numpy as np


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
