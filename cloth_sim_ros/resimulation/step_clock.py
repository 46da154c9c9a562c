# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""From the stamps of a recording to the steps of a run."""

import math
from typing import Any

_SECOND = 1_000_000_000
_NOTHING = 1e-6


class StepClock:
    """
    Tell how many steps of dt lie before a recorded moment.

    A stamp has whole nanoseconds and dt need not, so the recorded step is the nearest one.

    :param recorded_dt: of the recorded run [s]
    :param dt: of the run that is made now [s]; with another one, a moment within a step is taken
        at the beginning of that step
    """

    def __init__(self, recorded_dt: float, dt: float) -> None:
        """Keep both."""
        self._recorded_dt = recorded_dt
        self._dt = dt

    def recorded_time(self, stamp: Any) -> float:
        """Return the simulated time of ``stamp`` [s], with all the digits of the recorded run."""
        return self._recorded_steps(stamp) * self._recorded_dt

    def steps(self, stamp: Any) -> int:
        """Return the steps made before the moment of ``stamp``, a ROS time."""
        if self._dt == self._recorded_dt:
            return self._recorded_steps(stamp)
        return math.floor(self.recorded_time(stamp) / self._dt + _NOTHING)

    def _recorded_steps(self, stamp: Any) -> int:
        # The whole seconds stay integers: a sum of floats would lose the last digits.
        return round((stamp.sec * _SECOND + stamp.nanosec) / (self._recorded_dt * _SECOND))
