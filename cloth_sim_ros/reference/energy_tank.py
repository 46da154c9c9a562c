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

"""What a limit took from a cloth's energy and may give back, in float64."""

import math

# Of the kinetic energy; [s]; [s].
_CREDIT, _MEMORY, _SLOWEST = 0.01, 0.1, 0.3


class EnergyTankReference:
    """Pays for what brings edges back to their limit (docs/adaptive.md, Energy)."""

    def __init__(self, reach: float) -> None:
        """
        Start with nothing.

        :param reach: how far what is applied may be lifted on credit [m]
        """
        self._reach = reach
        self._energy = self._credit = self._cost = 0.0

    @property
    def is_overdrawn(self) -> bool:
        """Tell whether more was given than was taken, credit included."""
        return self._energy + self._credit < 0.0

    def share(self, wanted: float, h: float) -> float:
        """Return how much of each overshoot may be taken back within h [s]."""
        if self._cost == 0.0:
            return wanted
        funded = max(self._energy + self._credit, 0.0) / self._cost
        return min(wanted, max(funded, h / _SLOWEST))

    def book(self, taken: float, cost: float, kinetic: float, load: float, h: float) -> None:
        """
        Take down what a substep of h [s] did.

        :param taken: kinetic energy that the limit took [J]
        :param cost: work that would bring all edges back to it [J]
        :param kinetic: energy that the cloth has [J]
        :param load: magnitudes of what is applied, summed over nodes and pushes [N]
        """
        self._energy += taken
        if self._energy > 0.0:
            self._energy = min(self._energy, cost)
        else:
            self._energy *= math.exp(-h / _MEMORY)
        self._credit = _CREDIT * kinetic + load * self._reach
        self._cost = cost
