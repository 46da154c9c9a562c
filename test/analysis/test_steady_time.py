# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Time over resets."""

from types import SimpleNamespace

from cloth_sim_ros.analysis.steady_time import SteadyTime
import pytest


def test_it_goes_on_where_a_reset_put_the_clock_back():
    """What came after a reset would be mixed with what was before."""
    time = SteadyTime()
    stamps = [(0, 0), (1, 500000000), (0, 0), (2, 0), (0, 250000000)]
    read = [time.read(SimpleNamespace(sec=sec, nanosec=nanosec)) for sec, nanosec in stamps]
    assert read == [0.0, 1.5, 1.5, 3.5, 3.75]


def test_it_begins_where_the_recording_begins():
    """A recording that was started late would seem to start at 0."""
    assert SteadyTime().read(SimpleNamespace(sec=7, nanosec=0)) == 7.0


def test_a_late_message_is_no_reset():
    """Clouds that came after the figures of the next frame would shift all that follow."""
    time = SteadyTime()
    given = [
        ('stats', 0.0), ('points', 0.0), ('stats', 0.02), ('stats', 0.04), ('points', 0.02),
        ('points', 0.04), ('push', 0.02), ('stats', 0.06)]
    read = [time.read(_stamp(at), topic) for topic, at in given]
    assert read == pytest.approx([at for _, at in given])


def test_every_topic_learns_of_a_reset():
    """A push after a reset would be shown before it, where its topic is seldom sent."""
    time = SteadyTime()
    given = [
        ('push', 0.5), ('points', 5.0), ('stats', 4.98), ('points', 0.0), ('stats', 5.0),
        ('points', 0.02), ('stats', 0.0), ('push', 1.0), ('points', 1.0)]
    read = [time.read(_stamp(at), topic) for topic, at in given]
    assert read == pytest.approx([0.5, 5.0, 4.98, 5.0, 5.0, 5.02, 5.0, 6.0, 6.0])


def _stamp(seconds):
    return SimpleNamespace(sec=int(seconds), nanosec=round(seconds % 1.0 * 1e9))
