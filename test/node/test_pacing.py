# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How long the node waits between frames."""

from cloth_sim_ros.node.pacing import Pacing
import pytest


def test_waits_for_the_rest_of_a_frame():
    """A node that took 5 ms for a frame of 20 ms would not run at real time."""
    pacing = Pacing(1.0)
    pacing.restart(100.0)
    assert pacing.delay(100.005, 0.02) == pytest.approx(0.015)


@pytest.mark.parametrize('factor, wait', [(2.0, 0.01), (0.5, 0.04)])
def test_keeps_to_the_factor(factor, wait):
    """Twice real time would not halve the wait, or half real time not double it."""
    pacing = Pacing(factor)
    pacing.restart(0.0)
    assert pacing.delay(0.0, 0.02) == pytest.approx(wait)


def test_factor_0_never_waits():
    """As fast as possible would still be paced."""
    pacing = Pacing(0.0)
    pacing.restart(0.0)
    assert [pacing.delay(0.001 * i, 0.02) for i in range(5)] == [0.0] * 5


def test_catches_up_after_a_late_frame():
    """One late frame would make the whole run late."""
    pacing = Pacing(1.0)
    pacing.restart(0.0)
    assert pacing.delay(0.05, 0.02) == 0.0
    assert pacing.delay(0.051, 0.02) == 0.0
    assert pacing.delay(0.052, 0.02) == pytest.approx(0.008)


def test_gives_up_what_is_too_late_to_catch_up_with():
    """After a long halt the node would run without a pause for as long again."""
    pacing = Pacing(1.0)
    pacing.restart(0.0)
    pacing.delay(10.0, 0.02)
    waits = [pacing.delay(10.0, 0.02) for _ in range(20)]
    assert waits[0] == 0.0
    assert waits[-1] > 0.0


def test_measures_the_factor_achieved():
    """The factor in ~/stats would not be simulated time over wall time."""
    pacing = Pacing(1.0)
    pacing.restart(0.0)
    assert pacing.achieved == 0.0
    for frame in range(1, 201):
        pacing.delay(0.04 * frame, 0.02)
    assert pacing.achieved == pytest.approx(0.5)


@pytest.mark.parametrize('frame_time, too_slow', [(0.04, True), (0.02, False)])
def test_tells_when_it_is_too_slow(frame_time, too_slow):
    """A slow machine would not be told of, or a fast enough one would."""
    pacing = Pacing(1.0)
    pacing.restart(0.0)
    pacing.delay(frame_time, 0.02)
    assert not pacing.too_slow, 'one frame says nothing yet'
    for frame in range(2, 201):
        pacing.delay(frame_time * frame, 0.02)
    assert pacing.too_slow == too_slow
