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

"""Mass-spring forces and update in one pass, from one pair of buffers to the other."""

from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_program import SceneProgram
from cloth_sim_ros.sim.state import State


class OnePass:
    """The fused layout: mass_spring_step.comp."""

    def __init__(self, scene: Scene, layout: Layout) -> None:
        """Compile the pass."""
        self._step = SceneProgram('mass_spring_step.comp', scene, layout)
        self._groups = layout.groups
        self._step.use()

    def substep(self, state: State, forcing: Forcing, length: float) -> None:
        """Step ``state`` on by ``length`` [s]."""
        state.bind_in()
        state.bind_out()
        step = self._step.use_for_step(forcing, length)
        step.dispatch(*self._groups)
        shader_writes_visible()
        state.swap()

    def delete(self) -> None:
        """Give nothing back: the pass allocates nothing."""
