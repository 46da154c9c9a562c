# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How far a run has come, and how far it is to go."""

import math

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.arguments import integer
from cloth_sim_ros.sim.arguments import real_number
from cloth_sim_ros.sim.errors import ClothSimError

# The largest simulated time [s]: seconds are an int32 in a time stamp of ROS.
LATEST = 2**31 - 2


class Stepping:
    """
    Count steps of dt towards an aim.

    :param dt: [s]
    :param steps: made before
    """

    _carried: float

    def __init__(self, dt: float, steps: int = 0) -> None:
        """Aim at the present time."""
        self._dt = dt
        self.steps = steps
        self.drop_aim()

    @property
    def time(self) -> float:
        """Return the simulated time [s]."""
        return self.steps * self._dt

    @property
    def is_behind(self) -> bool:
        """Return whether there are steps to make before the aim is reached."""
        return self.steps < self.goal

    def is_last(self, number: int) -> bool:
        """Return whether the aim is reached with the step of that ``number``."""
        return number + 1 == self.goal

    def aim(self, seconds: float) -> None:
        """Advance by ``seconds`` more; a remainder below dt is carried over."""
        carried = self._carried + self.checked_seconds(seconds)
        # The small share keeps a sum of frame times from falling just short of a step.
        count = math.floor(carried / self._dt + 1e-6)
        self._aim_at(self.goal + count)
        # Only the remainder is summed: a sum of all times would lose its last digits.
        self._carried = carried - count * self._dt

    def checked_seconds(self, seconds: float) -> float:
        """Return ``seconds`` as a float; ClothSimError where a run can't advance by so much."""
        seconds = real_number(seconds, 'the time to advance by', 'give it in seconds')
        if not math.isfinite(seconds) or seconds < 0.0:
            raise ClothSimError(f'cannot advance by {seconds} s: give a time of 0 s or more')
        # Before it is counted in steps, of which there may be more than a float can tell.
        refuse_later_than_latest(self.time + self._carried + seconds)
        return seconds

    def aim_steps(self, count: int) -> None:
        """Make ``count`` steps of dt from now on."""
        self._aim_at(self.steps + checked_steps(count, self.steps, self._dt))
        self._carried = 0.0

    def drop_aim(self) -> None:
        """Aim at the present time of the run."""
        self.goal, self._carried = self.steps, 0.0

    def _aim_at(self, goal: int) -> None:
        refuse_later_than_latest(goal * self._dt)
        self.goal = goal


def checked_steps(count: int, made: int, dt: float) -> int:
    """
    Return ``count`` as an int, or raise ClothSimError when so many steps of dt can't be made.

    :param made: steps before
    :param dt: [s]
    """
    count = integer(count, 'the number of steps', 'give an int, or advance by seconds')
    if count < 0:
        raise ClothSimError(f'cannot make {shown(count)} steps: give 0 or more')
    # An int of any size is compared with a float without overflow.
    refuse_later_than_latest((made + count) * dt if count < LATEST / dt else math.inf)
    return count


def refuse_later_than_latest(time: float) -> None:
    """Raise ClothSimError when a run would go on until ``time`` [s]."""
    if time > LATEST:
        raise ClothSimError(
            f'simulated time ends at {LATEST} s, like ROS time stamps, and the run would '
            f'reach {time:.10g} s: reset it, which restarts at 0')
