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

"""How hard edges are whose cloth comes stretched from where it was no constraint."""

import math

# [m/s]: a cloth whose edges come back slower is held at once.
_SLOW = 0.05


class Hardening:
    """
    From the springs of the scene, at 0, to hard edges, at 1, in a given time.

    Held to its rest length at once, a stretched cloth would be thrown together: its edges would
    come back at the speed of their extension over a step, and go on at that.

    :param time: at most [s]; 0 holds edges at once
    """

    def __init__(self, time: float) -> None:
        """Wait for what is seen first."""
        self._time = time
        self.forget()

    @property
    def hardness(self) -> float:
        """Return how far it has come, from 0 to 1."""
        return min(self._age / self._due, 1.0) if self._is_going else 1.0

    def see(self, speed: float, misfit: float = math.inf) -> None:
        """
        Take the ``speed`` [m/s] at which edges held now would come back; the first counts.

        :param misfit: by which they are off their length [m]
        """
        if self._is_new:
            # What is no number goes the gentle way, too.
            self._is_going = self._time > 0.0 and not speed <= _SLOW
            # No longer than it takes to come back slowly: springs too soft for the cloth let it
            # fall meanwhile.
            enough = misfit / _SLOW
            self._due = enough if enough < self._time else self._time
        self._is_new = False

    def spend(self, length: float) -> None:
        """Go on by ``length`` [s]."""
        if self._is_going:
            self._age += length
            self._is_going = self._age < self._due

    def forget(self) -> None:
        """Wait for what is seen next."""
        self._is_new = True
        self._due = self._time
        self._is_going = False
        self._age = 0.0
