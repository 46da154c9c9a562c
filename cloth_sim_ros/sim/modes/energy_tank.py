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

"""Let a limit give a cloth no more energy than it has taken from it."""

import math

from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.modes.sweeps import Held
from cloth_sim_ros.sim.scene import Scene

# Of the kinetic energy: what may be given beyond what was taken.
_CREDIT = 0.01
# [s]: what was given on credit is forgotten.
_MEMORY = 0.1
# [s]: an edge beyond its limit comes back with this time constant though there is no energy.
_SLOWEST = 0.3


class EnergyTank:
    """
    Keeps account of the energy that tensions at a limit take and give.

    An edge that is beyond its limit is brought back by work against its tension. It took energy to
    get there, but at the tension of then; where a cloth is being caught, tensions grow by the
    hundredfold meanwhile, and the cloth is thrown. So what brings edges back is paid from a tank
    that tensions fill as they brake the cloth (energy tanks for passivity,
    DOI 10.1109/TRO.2011.2142430).

    A cloth that hangs at its limit trembles, and loses energy by it. So that it does not sink,
    what is applied may be lifted as far as an edge may stretch, on credit.

    :param reach: what an edge may stretch [m]
    """

    def __init__(self, scene: Scene, reach: float) -> None:
        """Start with an empty tank."""
        self._node_mass = scene.node_mass
        self._node_count = scene.node_count
        self._reach = reach
        self.forget()

    @property
    def is_overdrawn(self) -> bool:
        """Tell whether more was given than was taken, credit included."""
        return self._energy + self._credit < 0.0

    def share(self, wanted: float, length: float) -> float:
        """Return how much of each overshoot a substep of ``length`` [s] may take back, to 1."""
        if not self._cost:
            return wanted
        funded = max(self._energy + self._credit, 0.0) / self._cost
        return min(wanted, max(funded, length / _SLOWEST))

    def book(self, held: Held, forcing: Forcing, length: float) -> None:
        """Take down what tensions did in a substep of ``length`` [s] under ``forcing``."""
        if not held.pull:
            self.forget()
            return
        energy = self._energy + held.taken
        # More than brings all edges back is of no use now, and would be too much later.
        self._energy = min(energy, held.cost) if energy > 0.0 else (
            energy * math.exp(-length / _MEMORY))
        self._credit = self._node_mass * (
            _CREDIT * 0.5 * held.square + forcing.sum_over(self._node_count) * self._reach)
        self._cost = held.cost

    def forget(self) -> None:
        """Have taken and given nothing, as at the start."""
        self._energy = self._credit = self._cost = 0.0
