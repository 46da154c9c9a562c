# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Simulated time as ROS writes it."""

import math

from builtin_interfaces.msg import Time

NANOSECONDS = 1_000_000_000


def nanoseconds(seconds: float) -> int:
    """Return simulated ``seconds`` as whole nanoseconds, to the nearest."""
    # The whole seconds stay integers: multiplied in one go, a float loses the last digits.
    whole = math.floor(seconds)
    return whole * NANOSECONDS + round((seconds - whole) * NANOSECONDS)


def stamp(seconds: float) -> Time:
    """Return simulated ``seconds`` as a ROS time."""
    sec, nanosec = divmod(nanoseconds(seconds), NANOSECONDS)
    return Time(sec=sec, nanosec=nanosec)
