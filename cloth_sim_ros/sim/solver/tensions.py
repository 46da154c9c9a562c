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

"""The tension of each edge, which the solves of a step find together."""

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.sim import bindings
from cloth_sim_ros.sim.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_program import rest_lengths
from cloth_sim_ros.sim.solver.levels import Levels
from cloth_sim_ros.sim.solver.solver_pass import SolverPass
from cloth_sim_ros.sim.solver.solver_programs import SolverPrograms
import numpy as np

# Room for 8 at a node, of which 6 are used, shaders/include/solver/tension.glsl.
_ROOM = 8


class Tensions:
    """
    The tensions on the device, and the passes that read them.

    :param has_lag: True when edges with damping are part of the system
    """

    def __init__(
            self, scene: Scene, programs: SolverPrograms, levels: Levels, *,
            has_lag: bool) -> None:
        """Compile the passes and allocate the tensions, zero at first."""
        self._levels = levels
        self.cloth: Layout = levels.cloth
        self._node_mass = scene.node_mass
        self._zeros = np.zeros((4 if has_lag else 3, self.cloth.stored, _ROOM), dtype=np.float32)
        self.buffer = Buffer(self._zeros)
        later = programs.make('later_right_side.comp', HAS_LAG=int(has_lag))
        later.set_floats('rest_length', rest_lengths(scene))
        self.later_right_side = SolverPass(later, self.cloth.groups)
        self.find = SolverPass(programs.make('find_tension.comp'), self.cloth.groups)

    def bind(self) -> None:
        """Let the next dispatch reach the tensions."""
        self.buffer.bind_storage(bindings.SOLVER_TENSION)

    def bind_for(self, program: Program) -> None:
        """Let the program in use, which runs on the lattice of the state, reach the tensions."""
        self.bind()
        self._levels.set_solver_lattice(program)

    def clear(self) -> None:
        """Make all tensions zero."""
        self.buffer.write(self._zeros)

    def read(self) -> np.ndarray:
        """Return the tension of every edge [N], (rows, cols, 6) float32 as in Snapshot."""
        found = np.empty(self._zeros.shape[1:], dtype=np.float32)
        self.buffer.read_into(found)
        return np.float32(self._node_mass) * self.cloth.load(found)[..., :len(EDGE_KINDS)]

    def delete(self) -> None:
        """Give the tensions back."""
        self.buffer.delete()
