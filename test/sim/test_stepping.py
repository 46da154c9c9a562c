# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How many steps of dt a run makes, and how long it can go on."""

from fractions import Fraction
import math

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.stepping import LATEST
from cloth_sim_ros.sim.stepping import Stepping
import pytest


def make_all(stepping: Stepping) -> None:
    """Count the steps up to the aim as made."""
    stepping.steps = stepping.goal
    assert not stepping.is_behind


@pytest.mark.parametrize(('dt', 'frame'), [(0.005, 0.02), (0.003, 0.02), (0.02, 0.0007)])
def test_frames_add_up_for_days(dt: float, frame: float):
    """Rounding errors would add up, and frames have a step more or less after some hours."""
    stepping = Stepping(dt)
    exact, step = Fraction(str(frame)), Fraction(str(dt))
    for number in range(1, 1_000_001):
        stepping.aim(frame)
        if number % 9973 == 0:
            make_all(stepping)
            assert stepping.steps == math.floor(number * exact / step)


def test_a_run_ends_where_stamps_end():
    """The stamp of a frame would be no int32, and every frame from then on fail."""
    stepping = Stepping(1.0, steps=LATEST - 2)
    stepping.aim(2.0)
    make_all(stepping)
    assert stepping.time == LATEST
    for ask in (stepping.aim, stepping.aim_steps):
        with pytest.raises(ClothSimError, match=f'ends at {LATEST} s.* reset it'):
            ask(1)
    assert stepping.steps == LATEST and not stepping.is_behind


def test_an_aim_can_be_dropped():
    """What was not made would be made up for by the next call."""
    stepping = Stepping(0.01, steps=3)
    stepping.aim(0.055)
    assert (stepping.goal, stepping.is_behind, stepping.is_last(7)) == (8, True, True)
    stepping.steps = 5
    stepping.drop_aim()
    assert (stepping.goal, stepping.is_behind) == (5, False)
    # The remainder of the frame is gone with it.
    stepping.aim(0.0199)
    assert stepping.goal == 6
