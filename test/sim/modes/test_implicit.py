# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A limit that closes in begins where the cloth is, and ends with hard edges."""

import math

from cloth_sim_ros.sim.modes.implicit import Settling
import numpy as np
import pytest


def _limits(strain, count=40):
    settling = Settling(0.01, 1.0)
    settling.begin(strain)
    limits = []
    for _ in range(count):
        limits.append(settling.limit)
        settling.advance(0.01)
    return np.array(limits)


def test_closes_in_from_the_strain_of_the_cloth():
    """A stretched cloth would be held at once, or for ever."""
    limits = _limits(0.5)
    assert limits[0] == pytest.approx(0.5)
    assert np.all(np.diff(limits) <= 0.0)
    assert np.all(limits[31:] == 0.0)


def test_begins_and_ends_at_rest():
    """The cloth would be jerked when the limit begins to close in, or when it is there."""
    speeds = -np.diff(_limits(0.5))
    assert speeds[0] < 0.1 * speeds.max()
    assert speeds[29] < 0.1 * speeds.max()


def test_only_a_new_cloth_counts():
    """A cloth that is stretched by a push would be let go."""
    settling = Settling(0.01, 1.0)
    settling.begin(1e-4)
    settling.begin(0.5)
    assert settling.limit == 0.0
    settling.forget()
    settling.begin(0.5)
    assert settling.limit == 0.5


@pytest.mark.parametrize('strain', [0.009, math.nan])
def test_what_is_held_at_once(strain):
    """A cloth that is hardly stretched would sag first, or the limit would be no number."""
    assert np.all(_limits(strain) == 0.0)
