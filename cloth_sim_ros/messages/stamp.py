# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Simulated time as ROS writes it.

A stamp is an epoch, the stamp of simulated time 0 [ns], and the simulated time since.
"""

import math
import struct

from builtin_interfaces.msg import Time
from cloth_sim_ros.messages.cdr_writer import ENCAPSULATION

NANOSECONDS = 1_000_000_000
# A stamp in CDR, and its place in a message that begins with a header: behind the encapsulation.
STAMP = struct.Struct('<iI')
STAMP_AT = len(ENCAPSULATION)


def nanoseconds(seconds: float) -> int:
    """Return simulated ``seconds`` as whole nanoseconds, to the nearest."""
    # The whole seconds stay integers: multiplied in one go, a float loses the last digits.
    whole = math.floor(seconds)
    return whole * NANOSECONDS + round((seconds - whole) * NANOSECONDS)


def stamp(seconds: float, epoch: int = 0) -> Time:
    """Return simulated ``seconds`` after ``epoch`` [ns] as a ROS time."""
    sec, nanosec = stamp_parts(seconds, epoch)
    return Time(sec=sec, nanosec=nanosec)


def stamp_parts(seconds: float, epoch: int = 0) -> tuple[int, int]:
    """Return the fields of that, sec and nanosec, for messages that are no objects."""
    return divmod(epoch + nanoseconds(seconds), NANOSECONDS)


def serialise_clock(seconds: float, epoch: int = 0) -> bytes:
    """Return the CDR bytes of a rosgraph_msgs/Clock at simulated ``seconds`` after ``epoch``."""
    return ENCAPSULATION + STAMP.pack(*stamp_parts(seconds, epoch))
