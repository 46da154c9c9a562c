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

"""The right side of the linearised step, on the device."""

from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_program import SceneProgram
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.levels import Levels
from cloth_sim_ros.sim.solver.solver_programs import SolverPrograms


class RightSide:
    """
    Runs right_side.comp, the part of it that edges and applied accelerations have.

    :param foresees_turn: allow for how much longer edges get by turning
    :param keeps_tension: begin the tension of each edge
    :param has_lag: and what damping makes of its extension
    """

    def __init__(
            self, scene: Scene, state: Layout, programs: SolverPrograms, levels: Levels, *,
            foresees_turn: bool, keeps_tension: bool, has_lag: bool) -> None:
        """Prepare; nothing is compiled yet."""
        self._program = SceneProgram('solver/right_side.comp', scene, state, {
            **programs.defines, 'FORESEES_TURN': int(foresees_turn),
            'KEEPS_TENSION': int(keeps_tension), 'HAS_LAG': int(has_lag)})
        self._programs = programs
        self._groups = levels.cloth.groups
        self._keeps_tension = keeps_tension
        self._law_in: EdgeLaw | None = None

    def run(self, law: EdgeLaw, forcing: Forcing, offset_share: float) -> None:
        """
        Make the right side of the state that is bound.

        :param offset_share: of the offsets of rest lengths, which ``keeps_tension`` has
        """
        program = self._program.use_for_step(forcing, law.length)
        if self._law_in != law:
            self._programs.set_sizes(program)
            program.set_floats('edge_weights', law.weights)
            program.set_floats('pinned_weights', law.pinned_weights)
            program.set_floats('edge_pulls', law.pulls)
            program.set_floats('edge_lags', law.lags)
            self._law_in = law
        if self._keeps_tension:
            program.set_float('offset_share', offset_share)
        program.dispatch(*self._groups)
        shader_writes_visible()
