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

"""A limit that a cloth stretched beyond it is brought to gently."""

import math

# Of the limit: more beyond it than an overshoot is.
_FAR = 0.5
# [s] of the decay.
_TIME = 0.3
# Of the limit: a slack that is none any more.
_NOTHING = 1e-3


class Slack:
    """
    What is added to the limit for a while, since a cloth can come from a mode without one.

    It begins at the strain the cloth has and decays as (1 + t / T) exp(-t / T), from standstill:
    held to the limit at once, the cloth would be thrown together.

    :param limit: strain
    """

    def __init__(self, limit: float) -> None:
        """Start without any."""
        self._limit = limit
        self.forget()

    @property
    def limit(self) -> float:
        """Return the limit that holds now."""
        return self._limit + self._first * (1.0 + self._age) * math.exp(-self._age)

    def see(self, strain: float) -> None:
        """Take the largest ``strain`` of a cloth; only the first one counts."""
        if self._is_new and strain > (1.0 + _FAR) * self._limit:
            self._first = strain - self._limit
        self._is_new = False

    def spend(self, length: float) -> None:
        """Go on by ``length`` [s]."""
        if self._first:
            self._age += length / _TIME
            if self.limit - self._limit < _NOTHING * self._limit:
                self._first = 0.0

    def forget(self) -> None:
        """Have none, until the next strain is seen."""
        self._first = self._age = 0.0
        self._is_new = True
