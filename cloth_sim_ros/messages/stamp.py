# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
