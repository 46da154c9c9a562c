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

"""Ask the device whether all positions and velocities are numbers that can be reckoned with."""

from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_program import SceneProgram
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.strips import Strips


class BoundsCheck:
    """Runs bounds_check.comp; compiles it when it is first asked."""

    def __init__(self, scene: Scene, layout: Layout) -> None:
        """Allocate its result."""
        self._strips = Strips(layout, 1)
        self._program = SceneProgram('bounds_check.comp', scene, layout, Strips.defines())

    def passes(self, state: State) -> bool:
        """Return whether nothing of ``state`` is NaN, infinite or beyond MOST_MAGNITUDE."""
        program = self._program.use()
        state.bind_in()
        self._strips.dispatch(program)
        return bool(self._strips.largest()[0] == 0.0)

    def delete(self) -> None:
        """Give pass and result back."""
        self._strips.delete()
        self._program.delete()
