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

"""The paper's adaptive scheme (Tab. 9): an edge beyond the limit is pulled to its rest length."""

from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.modes.held_tension import read_held_tension
from cloth_sim_ros.sim.modes.one_pass import OnePass
from cloth_sim_ros.sim.modes.strain_watch import StrainWatch
from cloth_sim_ros.sim.modes.sweeps import Sweeps
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.spring_tension import spring_tension
from cloth_sim_ros.sim.state import State
import numpy as np

# Enough for the linear system of a small cloth; the error falls by some 10 % a sweep.
_SWEEPS = 60


class PaperLimit:
    """
    Explicit springs within the limit, constraints to rest length beyond it.

    Kept for comparison: it fails at steps that the other schemes take (docs/adaptive.md).

    :param length: of each substep [s]
    :param watch: measures the strain
    """

    tensions = None

    def __init__(
            self, scene: Scene, layout: Layout, length: float, watch: StrainWatch) -> None:
        """Compile the passes."""
        self._scene = scene
        self._layout = layout
        self._limit: float = scene['adaptive.threshold']
        self._length = length
        self._watch = watch
        self._springs = OnePass(scene, layout, 'RIGID_LIMIT')
        self._sweeps = Sweeps(scene, layout, 'PAPER_LAW')
        self.forget()

    @property
    def is_idle(self) -> bool:
        """Tell whether no edge is beyond the limit."""
        return not self._some_beyond

    def see(self, strain: float) -> None:
        """Take no notice: the limit is where it is."""

    def next_length(self, acceleration: float) -> float:
        """Return the longest substep that may come next [s]."""
        return self._length

    def substep(self, state: State, forcing: Forcing, length: float, kick: float) -> None:
        """Step ``state`` on by ``length`` [s], with forces that act for ``kick`` [s]."""
        self._sweeps.clear()
        self._springs.run(state, forcing, length, kick)
        self._sweeps.bind_tensions()
        self._sweeps.run(state, _SWEEPS, length, kick, length, self._limit)
        self._sweeps.finish(state, length, kick, self._limit)
        self._some_beyond = self._watch.strains(state, forcing, 0.0)[0] > self._limit

    def tension(
            self, positions: np.ndarray, velocities: np.ndarray,
            nodes: np.ndarray | None = None) -> np.ndarray:
        """Return what each edge was pulled back with in the last substep, or its spring's [N]."""
        springs = spring_tension(self._scene, positions, velocities, nodes)
        if self.is_idle:
            return springs
        held = read_held_tension(self._sweeps.tensions, self._layout)
        return np.where(held == 0.0, springs, held)

    def forget(self) -> None:
        """Hold nothing, as at the start."""
        self._some_beyond = False

    def delete(self) -> None:
        """Give the buffers back."""
        self._sweeps.delete()
