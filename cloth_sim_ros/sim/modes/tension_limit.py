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

"""Limit the strain by constraints with multipliers that are kept from substep to substep."""

import math

from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.modes.energy_tank import EnergyTank
from cloth_sim_ros.sim.modes.held_tension import read_held_tension
from cloth_sim_ros.sim.modes.one_pass import OnePass
from cloth_sim_ros.sim.modes.slack import Slack
from cloth_sim_ros.sim.modes.sweeps import Sweeps
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.spring_tension import spring_tension
from cloth_sim_ros.sim.state import State
import numpy as np

# Substep over the one at which the pull of the tensions across the edges would blow up, at this
# limit [strain]. It goes with this power of the limit: the overshoot goes with the square of the
# substep, so it stays the same part of the limit.
_GEOMETRIC_SHARE, _USUAL_LIMIT, _SHARE_POWER = 0.15, 0.1, 0.5
_GROWTH = 1.1
# The least share of what is beyond the limit that a substep takes back. All of it, in a substep
# that has just become much shorter, throws the nodes apart, and the next one is shorter still.
_LEAST_CORRECTION = 0.2
# Of the present substep, in the length that counts as usual.
_USUAL_SHARE = 0.02
_SHORTEST_SHARE = 1e-3
# Of the way to its limit, by which what is applied alone may stretch an edge in a substep.
_FALL = 0.25
# More sweeps, where edges beyond their limit may not come back at once: fewer get there.
_MORE_SWEEPS = 2


class TensionLimit:
    """
    Coloured Gauss-Seidel on velocities, warm-started with each edge's tension.

    :param longest: substep that the springs allow [s]
    :param fixed: True to take the longest substep always
    """

    def __init__(self, scene: Scene, layout: Layout, longest: float, *, fixed: bool) -> None:
        """Compile the passes and allocate the tensions."""
        self._scene = scene
        self._layout = layout
        self._node_mass = scene.node_mass
        self._longest = longest
        self._fixed = fixed
        # What an edge may stretch [m].
        self._reach: float = scene['adaptive.threshold'] * min(scene.spacing)
        self._share = _GEOMETRIC_SHARE * (
            scene['adaptive.threshold'] / _USUAL_LIMIT)**_SHARE_POWER
        self._slack = Slack(scene['adaptive.threshold'])
        self._tank = EnergyTank(scene, self._reach)
        self._count: int = scene['adaptive.sweeps']
        self._springs = OnePass(scene, layout, 'TENSION_LIMIT')
        self._sweeps = Sweeps(scene, layout, 'LIMIT_LAW')
        self.tensions = self._sweeps.tensions
        self.forget()

    @property
    def is_idle(self) -> bool:
        """Tell whether no edge was held in the last substep."""
        return self._pull == 0.0

    def see(self, strain: float) -> None:
        """Take the largest strain, for a cloth that comes from beyond the limit."""
        self._slack.see(strain)

    def next_length(self, acceleration: float) -> float:
        """Return the longest substep that may come next [s]."""
        if self._fixed:
            return self._longest
        allowed = min(_GROWTH * self._length, self._longest)
        if self._pull > 0.0:
            allowed = min(allowed, self._share * math.sqrt(2.0 * self._node_mass / self._pull))
        if acceleration > 0.0:
            allowed = min(allowed, math.sqrt(2.0 * _FALL * self._reach / acceleration))
        self._length = max(allowed, _SHORTEST_SHARE * self._longest)
        return self._length

    def substep(self, state: State, forcing: Forcing, length: float, kick: float) -> None:
        """Step ``state`` on by ``length`` [s], with forces that act for ``kick`` [s]."""
        limit = self._slack.limit
        wanted = max(
            _LEAST_CORRECTION * min(1.0, length / self._usual), length / self._longest)
        count = self._count * (_MORE_SWEEPS if self._tank.is_overdrawn else 1)
        self._sweeps.bind_tensions()
        self._springs.run(state, forcing, length, kick)
        self._sweeps.run(
            state, count, length, kick, _GROWTH * max(self._length, length), limit,
            self._tank.share(wanted, length))
        held = self._sweeps.finish(state, length, kick, limit)
        self._usual += _USUAL_SHARE * (length - self._usual)
        self._slack.spend(length)
        self._tank.book(held, forcing, length)
        self._pull = held.pull

    def tension(
            self, positions: np.ndarray, velocities: np.ndarray,
            nodes: np.ndarray | None = None) -> np.ndarray:
        """Return the tension of every spring, and what held its edge in the last substep [N]."""
        springs = spring_tension(self._scene, positions, velocities, nodes)
        if self.is_idle:
            return springs
        return springs + read_held_tension(self.tensions, self._layout)

    def forget(self) -> None:
        """Hold nothing, as at the start."""
        self._pull = 0.0
        self._length = self._longest
        self._usual = self._longest
        self._slack.forget()
        self._tank.forget()
        self._sweeps.clear()

    def delete(self) -> None:
        """Give the tensions back."""
        self._sweeps.delete()
