# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What blows, and when."""

import math

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.wind import checked_wind
from cloth_sim_ros.sim.model.wind import Gust
from cloth_sim_ros.sim.model.wind import Wind
import numpy as np
import pytest

GUSTS = (Gust(1.0, 0.5, (3.0, 0.0, 0.0)), Gust(1.25, 1.0, (0.0, -2.0, 0.0)))


@pytest.mark.parametrize(('begin', 'end', 'expected'), [
    (0.0, 1.0, (0.0, 0.0, 1.0)), (1.0, 1.25, (3.0, 0.0, 1.0)), (1.25, 1.5, (3.0, -2.0, 1.0)),
    (1.5, 1.6, (0.0, -2.0, 1.0)), (0.5, 1.5, (1.5, -0.5, 1.0)), (3.0, 4.0, (0.0, 0.0, 1.0))])
def test_gusts_come_on_top_of_the_steady_wind(begin, end, expected):
    """A gust would blow at another time, or for whole steps."""
    np.testing.assert_allclose(Wind((0.0, 0.0, 1.0), GUSTS).mean(begin, end), expected)


def test_no_wind_is_faster_than_it_says():
    """The air would be looked at too seldom in a gust."""
    assert Wind((0.0, 0.0, 4.0), GUSTS).fastest == pytest.approx(9.0)


@pytest.mark.parametrize('velocity', [
    (1.0, 2.0), (0.0, math.nan, 0.0), (0.0, 0.0, math.inf), (1001.0, 0.0, 0.0)])
def test_what_is_no_wind_is_refused(velocity):
    """A cloth would be blown out of all bounds."""
    with pytest.raises(ClothSimError, match='at most 1000 m/s each, got .*: give x, y and z'):
        checked_wind(velocity)
