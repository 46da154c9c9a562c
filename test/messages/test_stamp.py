# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Simulated time as ROS writes it."""

from fractions import Fraction

from cloth_sim_ros.messages.stamp import nanoseconds
from cloth_sim_ros.messages.stamp import serialise_clock
from cloth_sim_ros.messages.stamp import stamp
from hypothesis import given
from hypothesis import strategies
import pytest
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock


@given(
    steps=strategies.integers(0, 10**8),
    dt=strategies.sampled_from(['0.005', '0.01', '0.001', '0.0025', '0.0001']))
def test_steps_of_dt_fall_on_exact_nanoseconds(steps, dt):
    """Stamps would drift against the steps they belong to."""
    exact = Fraction(dt) * steps * 10**9
    assert nanoseconds(steps * float(dt)) == exact


@pytest.mark.parametrize(('seconds', 'sec', 'nanosec'), [
    (0.0, 0, 0),
    (1.9999999999, 2, 0),
    (0.3, 0, 300000000),
    (0.1 + 0.2, 0, 300000000),
    (2147483646.5, 2147483646, 500000000),
])
def test_rounds_to_the_nearest_and_carries(seconds, sec, nanosec):
    """A stamp would be cut off instead of rounded, or hold 10^9 nanoseconds."""
    time = stamp(seconds)
    assert (time.sec, time.nanosec) == (sec, nanosec)


@pytest.mark.parametrize('seconds', [0.0, 0.02, 12.000000001, 2.0**31 - 2.5])
def test_a_clock_is_a_message_of_ros(seconds):
    """Nodes with use_sim_time would live at another time."""
    assert deserialize_message(serialise_clock(seconds), Clock).clock == stamp(seconds)


def test_an_epoch_is_added_to_the_nanosecond():
    """Stamps of the wall clock would be off by what a float loses of so many seconds."""
    time = stamp(0.1 + 0.2, 1_795_762_816_790_533_851)
    assert (time.sec, time.nanosec) == (1_795_762_817, 90_533_851)
    assert deserialize_message(serialise_clock(0.5, 10**18), Clock).clock == stamp(0.5, 10**18)
