# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Finding out where frames are missing."""

from cloth_sim_ros.analysis.gaps import find_gaps
import numpy as np
import pytest


def test_a_span_without_frames_is_found():
    """A run with a hole would be drawn as if nothing were missing."""
    times = np.array([0.0, 0.02, 0.04, 0.06, 0.3, 0.32, 0.34])
    gap, = find_gaps(times, np.zeros(7))
    assert gap == pytest.approx((0.06, 0.3))


@pytest.mark.parametrize('times, resets', [
    ([], []), ([1.0], [0]), ([0.0, 5.0], [0, 0]),
    (np.arange(50) / 50, np.zeros(50)),
    # At 60 Hz with steps of 5 ms, frames are 3 or 4 steps apart.
    (np.cumsum([3, 3, 4] * 20) * 0.005, np.zeros(60)),
    # The clock stood still, and a reset is no gap.
    ([0.0, 0.1, 0.1, 0.2, 0.9, 1.0, 1.1], [0, 0, 0, 0, 1, 1, 1])])
def test_whole_runs_have_none(times, resets):
    """A good recording would be said to have holes."""
    assert find_gaps(np.array(times, float), np.array(resets, float)) == []
