# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Mass-spring forces and update in one pass, from one pair of buffers to the other."""

from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_program import SceneProgram
from cloth_sim_ros.sim.state import State


class OnePass:
    """
    The fused layout: mass_spring_step.comp.

    :param strain_limit: which form of the pass, as the shader names them
    """

    def __init__(self, scene: Scene, layout: Layout, strain_limit: str = 'NO_LIMIT') -> None:
        """Compile the pass."""
        self._step = SceneProgram(
            'mass_spring_step.comp', scene, layout, {'STRAIN_LIMIT': strain_limit})
        self._groups = layout.groups
        self._step.use()

    def substep(
            self, state: State, forcing: Forcing, length: float,
            kick: float | None = None) -> None:
        """
        Step ``state`` on by ``length`` [s].

        :param kick: what forces act for [s], where the substep before had another length
        """
        self.run(state, forcing, length, kick)
        state.swap()

    def run(
            self, state: State, forcing: Forcing, length: float,
            kick: float | None = None) -> None:
        """Write the state after ``length`` [s], without making it the present one."""
        state.bind_in()
        state.bind_out()
        step = self._step.use_for_step(forcing, length, length if kick is None else kick)
        step.dispatch(*self._groups)
        shader_writes_visible()

    def delete(self) -> None:
        """Give the pass back."""
        self._step.delete()
