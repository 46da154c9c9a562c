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

"""Gauss-Seidel sweeps over the edges, colour by colour, on the velocities of a substep."""

from typing import NamedTuple

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim import bindings
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_program import SceneProgram
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.strips import Strips
import numpy as np

_COLOURS = 4
_TENSION_BYTES = 16


class Held(NamedTuple):
    """
    What the tensions of a substep did.

    :param pull: largest sum of tension over length at a free node [N/m]
    :param taken: kinetic energy that they took from the cloth [J]
    :param cost: work against them that would bring all edges back to their limit [J]
    :param square: sum of the squares of the free nodes' speeds [m2/s2]
    """

    pull: float
    taken: float
    cost: float
    square: float


class Sweeps:
    """
    The passes limit_sweep.comp and limit_finish.comp, and the tensions they work on.

    :param law: LIMIT_LAW or PAPER_LAW, as the shader names them
    """

    def __init__(self, scene: Scene, layout: Layout, law: str) -> None:
        """Compile the passes and allocate the tensions."""
        self._texture_loads = layout.texture_loads
        self._sweep = SceneProgram('limit_sweep.comp', scene, layout, {'SWEEP_LAW': law})
        self._finish = SceneProgram('limit_finish.comp', scene, layout, Strips.defines())
        self._strips = Strips(layout, len(Held._fields))
        self._threshold: float = scene['adaptive.threshold']
        # Cells of a colour lie in every other column and row.
        self._groups = tuple(
            -(-nodes // (2 * local))
            for nodes, local in zip((layout.cols, layout.rows), layout.local))
        self.tensions = Buffer(layout.stored * _TENSION_BYTES)
        self._sweep.use()
        self._finish.use()

    def bind_tensions(self) -> None:
        """Let the next dispatches read and write the tensions."""
        self.tensions.bind_storage(bindings.TENSION)
        if self._texture_loads:
            self.tensions.bind_texture(bindings.TENSION)

    def run(
            self, state: State, count: int, length: float, kick: float, longest_next: float,
            limit: float, correction: float = 1.0) -> None:
        """
        Sweep ``count`` times over velocities that a pass has written but not made present.

        :param length: of the substep [s]
        :param kick: what tensions act for in it [s]
        :param longest_next: that the next substep can have [s]
        :param limit: strain that holds in this substep
        :param correction: share of what is beyond the limit already that is taken back
        """
        if self._texture_loads:
            state.bind_out_for_reading()
        sweep = self._sweep.use()
        sweep.set_float('substep', length)
        sweep.set_float('kick', kick)
        sweep.set_float('limit', limit)
        sweep.set_float('longest_next', longest_next)
        sweep.set_float('correction', correction)
        for _ in range(count):
            for colour in range(_COLOURS):
                sweep.set_int('colour', colour)
                sweep.dispatch(*self._groups)
                shader_writes_visible()

    def finish(self, state: State, length: float, kick: float, limit: float) -> Held:
        """Move the nodes of the substep that ``run`` was told of; return what tensions did."""
        if self._texture_loads:
            state.bind_in()
        finish = self._finish.use()
        finish.set_float('substep', length)
        finish.set_float('kick', kick)
        finish.set_float('limit', limit)
        finish.set_float('held_share', (1.0 + limit) / (1.0 + self._threshold))
        self._strips.dispatch(finish)
        state.swap()
        figures = self._strips.read()
        return Held(float(figures[:, 0].max()), *figures[:, 1:].sum(axis=0, dtype=float).tolist())

    def clear(self) -> None:
        """Make all tensions zero."""
        self.tensions.write(np.zeros(self.tensions.bytes, dtype=np.uint8))

    def delete(self) -> None:
        """Give the buffers back."""
        self.tensions.delete()
        self._strips.delete()
