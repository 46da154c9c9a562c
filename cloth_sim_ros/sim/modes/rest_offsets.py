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


"""Hard edges that become stiffer keep their tension, not their rest length."""

from collections.abc import Collection
import math

from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_program import SceneProgram
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.tensions import Tensions
from cloth_sim_ros.sim.state import State

_LOCAL = (16, 2)


class RestOffsets:
    """
    What the rest lengths of hard edges are off by, and how that decays.

    A regularised hard edge is a spring, and its stiffness goes with 1 / h^2. Were a stretched
    edge just made stiffer, it would have more energy than was put into it.

    :param hard: families of the edges that have offsets
    :param time: in which offsets decay to 1 / e [s]; 0 has none
    """

    def __init__(
            self, scene: Scene, layout: Layout, hard: Collection[str], time: float,
            tensions: Tensions) -> None:
        """Begin without offsets; nothing is compiled yet."""
        self._time = time
        self._families = [index for index, family in enumerate(FAMILIES) if family in hard]
        self._tensions = tensions
        self._program = SceneProgram('rest_offset.comp', scene, layout, {
            'LOCAL_X': _LOCAL[0], 'LOCAL_Y': _LOCAL[1],
            **{f'HAS_{family.upper()}': int(family in hard) for family in FAMILIES}})
        self._groups = -(-layout.cols // _LOCAL[0]), -(-layout.rows // _LOCAL[1])
        self.forget()

    def forget(self) -> None:
        """Begin without offsets, whatever law comes next; their owner has cleared them."""
        self._law: EdgeLaw | None = None
        self._are_some = False
        self._age = 0.0

    def take_up(self, state: State, law: EdgeLaw) -> None:
        """Let ``law`` hold the edges from now on, with the tensions they have."""
        before, self._law = self._law, law
        if before is None or self._time == 0.0 or not self._families:
            return
        if not self._are_some and before == law:
            return
        free = [1.0] * len(FAMILIES)
        pinned = list(free)
        for index in self._families:
            free[index] = before.stiffnesses[index] / law.stiffnesses[index]
            pinned[index] = (
                free[index] * before.pinned_weights[index] / law.pinned_weights[index])
        program = self._program.use()
        program.set_float('offset_share', self.share(0.0))
        program.set_floats('softer', free)
        program.set_floats('softer_at_pins', pinned)
        state.bind_in()
        self._tensions.bind_for(program)
        program.dispatch(*self._groups)
        shader_writes_visible()
        self._are_some = True
        self._age = 0.0

    def share(self, length: float) -> float:
        """Return the share of the offsets left when ``length`` [s] more has passed."""
        if self._time == 0.0:
            return 0.0
        return math.exp(-(self._age + length) / self._time)

    def spend(self, length: float) -> None:
        """Go on by ``length`` [s]."""
        self._age += length
