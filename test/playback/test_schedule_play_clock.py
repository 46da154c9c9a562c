# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""When recorded messages are due."""

from cloth_sim_ros.playback.schedule import CATCH_UP
from cloth_sim_ros.playback.schedule import PlayClock
import pytest

SECOND = 10**9


@pytest.fixture(params=[0.25, 1.0, 4.0])
def rate(request):
    """Give a pace."""
    return request.param


@pytest.fixture
def clock(rate):
    """Return a clock that has 7 s of the recording due at 100 s of the wall clock."""
    clock = PlayClock(rate)
    clock.start(100.0, 7 * SECOND)
    return clock


def test_messages_are_due_at_their_times_over_the_rate(clock, rate):
    """The pace would not be the one asked for."""
    assert clock.delay(100.0, 7 * SECOND) == 0.0
    assert clock.delay(100.0, 9 * SECOND) == pytest.approx(2.0 / rate)
    assert clock.delay(100.0 + 1.5 / rate, 9 * SECOND) == pytest.approx(0.5 / rate)
    assert clock.furthest_behind == pytest.approx(0.0)


def test_what_is_late_is_caught_up(clock, rate):
    """A short stall would shift all that comes after it."""
    late = 0.5 * CATCH_UP
    assert clock.delay(100.0 + 1.0 / rate + late, 8 * SECOND) == 0.0
    assert clock.furthest_behind == pytest.approx(late)
    assert clock.slipped == 0.0
    assert clock.delay(100.0 + 1.0 / rate + late, 9 * SECOND) == pytest.approx(
        max(1.0 / rate - late, 0.0))


def test_after_a_long_stall_the_schedule_moves(clock, rate):
    """A process that was held up for a minute would pour that minute out at once."""
    assert clock.delay(160.0 + 1.0 / rate, 8 * SECOND) == 0.0
    assert clock.furthest_behind == pytest.approx(60.0)
    assert clock.slipped == pytest.approx(60.0 - CATCH_UP)
    assert clock.delay(160.0 + 1.0 / rate, 18 * SECOND) == pytest.approx(10.0 / rate - CATCH_UP)


def test_a_pause_shifts_what_comes_after(clock, rate):
    """Playing would jump ahead after a pause, or count it as being late."""
    clock.pause(100.5)
    clock.pause(101.0)
    assert clock.paused
    clock.resume(110.5)
    clock.resume(111.0)
    assert not clock.paused
    assert clock.delay(110.5, 17 * SECOND) == pytest.approx(10.0 / rate - 0.5)
    assert clock.furthest_behind <= 0.0


def test_a_start_while_paused_waits(clock, rate):
    """A round that begins in a pause would be late by the whole pause."""
    clock.pause(100.0)
    clock.start(105.0, 0)
    clock.resume(120.0)
    assert clock.delay(120.0, SECOND) == pytest.approx(1.0 / rate)


def test_messages_that_go_back_are_due_with_the_one_before(clock, rate):
    """A bag whose wall clock was set back would seem hours late."""
    clock.delay(100.0, 8 * SECOND)
    assert clock.delay(100.0, SECOND) == pytest.approx(1.0 / rate)
    assert clock.furthest_behind == 0.0
