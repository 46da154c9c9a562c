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

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim import bindings
from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.modes.one_pass import OnePass
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_program import SceneProgram
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.strips import Strips
import numpy as np

# Substep over that at which the pull of the tensions across the edges would blow up.
_GEOMETRIC_SHARE = 0.2
_GROWTH = 1.1
_SHORTEST_SHARE = 1e-3
_COLOURS = 4
_SOFTWARE_CELLS, _GPU_CELLS = 2, 1
_TENSION_BYTES = 16


class TensionLimit:
    """
    Coloured Gauss-Seidel on velocities, warm-started with each edge's tension.

    :param longest: substep that the springs allow [s]
    :param fixed: True to take the longest substep always
    """

    def __init__(self, scene: Scene, layout: Layout, longest: float, *, fixed: bool) -> None:
        """Compile the passes and allocate the tensions."""
        self._scene = scene
        self._longest = longest
        self._fixed = fixed
        self._sweeps: int = scene['adaptive.sweeps']
        self._layout = layout
        self._cells = _SOFTWARE_CELLS if layout.texture_loads else _GPU_CELLS
        self._springs = OnePass(scene, layout, 'TENSION_LIMIT')
        self._sweep = SceneProgram('limit_sweep.comp', scene, layout, {'CELLS': self._cells})
        self._finish = SceneProgram('limit_finish.comp', scene, layout, Strips.defines())
        self._strips = Strips(layout, 1)
        # Of a colour, blocks lie in every other column and row.
        self._groups = tuple(
            -(-nodes // (2 * self._cells * local))
            for nodes, local in zip((layout.cols, layout.rows), layout.local))
        self.tensions = Buffer(layout.stored * _TENSION_BYTES)
        self._sweep.use()
        self._finish.use()
        self.forget()

    @property
    def is_idle(self) -> bool:
        """Tell whether no edge was held in the last substep."""
        return self._pull == 0.0

    def next_length(self) -> float:
        """Return the longest substep that may come next [s]."""
        if not self._fixed:
            allowed = math.inf
            if self._pull > 0.0:
                allowed = _GEOMETRIC_SHARE * math.sqrt(2.0 * self._scene.node_mass / self._pull)
            self._length = max(
                min(allowed, _GROWTH * self._length, self._longest),
                _SHORTEST_SHARE * self._longest)
        return self._length

    def substep(self, state: State, forcing: Forcing, length: float) -> None:
        """Step ``state`` on by ``length`` [s]."""
        self._bind_tensions()
        self._springs.run(state, forcing, length)
        self._run_sweeps(length)
        finish = self._finish.use()
        finish.set_float('substep', length)
        self._strips.dispatch(finish)
        state.swap()
        self._pull = float(self._strips.largest()[0])

    def forget(self) -> None:
        """Hold nothing, as at the start."""
        self._pull = 0.0
        self._length = self._longest
        self.tensions.write(np.zeros(self._layout.stored * 4, dtype=np.float32))

    def delete(self) -> None:
        """Give the tensions back."""
        self.tensions.delete()
        self._strips.delete()

    def _bind_tensions(self) -> None:
        self.tensions.bind_storage(bindings.TENSION)
        if self._layout.texture_loads:
            self.tensions.bind_texture(bindings.TENSION)

    def _run_sweeps(self, length: float) -> None:
        sweep = self._sweep.use()
        sweep.set_float('substep', length)
        sweep.set_float('longest_next', _GROWTH * max(self._length, length))
        for _ in range(self._sweeps):
            for colour in range(_COLOURS):
                sweep.set_int('colour', colour)
                sweep.dispatch(*self._groups)
                shader_writes_visible()
