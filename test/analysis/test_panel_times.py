# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Which moments a picture shows by itself."""

from cloth_sim_ros.analysis.panel_times import panel_times
from cloth_sim_ros.sim.push import Push
import pytest


def push(start, duration):
    """Return a push that acts then."""
    return Push.checked(force=(1.0, 0.0, 0.0), start=start, duration=duration)


def test_without_pushes_they_are_evenly_apart():
    """Part of a run would not be seen."""
    assert panel_times(1.0, 3.0, [], 5) == pytest.approx([1.0, 1.5, 2.0, 2.5, 3.0])


def test_the_nearest_moves_into_a_push():
    """A short push would fall between two panels."""
    assert panel_times(0.0, 4.0, [push(2.3, 0.2)], 5) == pytest.approx([0.0, 1.0, 2.4, 3.0, 4.0])


def test_two_pushes_close_together_are_both_seen():
    """The second push would take the panel of the first."""
    times = panel_times(0.0, 4.0, [push(1.9, 0.2), push(2.2, 0.2)], 5)
    assert times == pytest.approx([0.0, 1.0, 2.0, 2.3, 4.0])


def test_more_pushes_than_panels_are_no_harm():
    """A run with many pushes could not be drawn."""
    times = panel_times(0.0, 1.0, [push(0.1 * number, 0.05) for number in range(10)], 4)
    assert len(times) == 4 and times == sorted(times)


def test_one_panel_is_enough():
    """A single panel could not be asked for."""
    assert panel_times(0.5, 1.0, [push(0.6, 0.1)], 1) == [0.5]
