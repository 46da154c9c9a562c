# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Mass-spring forces and update, in one pass or in the two of the paper."""

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim import bindings
from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_program import SceneProgram
from cloth_sim_ros.sim.state import State
import numpy as np


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
        if forcing.touch is not None:
            state.bind_expected()
            forcing.touch.act(length)

    def delete(self) -> None:
        """Give the pass back."""
        self._step.delete()


_UPDATE_LOCAL = 1024
_FORCE_BYTES = 16


class TwoPass:
    """Forces into a buffer (paper, Tab. 1), then the update (Tab. 2)."""

    def __init__(self, scene: Scene, layout: Layout) -> None:
        """Compile both passes and allocate the force and mass buffers."""
        self._force = SceneProgram('paper_force.comp', scene, layout)
        self._update = SceneProgram(
            'paper_update.comp', scene, layout, {'UPDATE_LOCAL': _UPDATE_LOCAL})
        self._forces = Buffer(layout.stored * _FORCE_BYTES)
        self._masses = Buffer(np.full(layout.stored, scene.node_mass, dtype=np.float32))
        self._force_groups = layout.groups
        self._update_groups = -(-scene.node_count // _UPDATE_LOCAL)
        self._force.use()
        self._update.use()

    def substep(self, state: State, forcing: Forcing, length: float) -> None:
        """Step ``state`` on by ``length`` [s], in place."""
        state.bind_in()
        self._forces.bind_storage(bindings.FORCE)
        self._masses.bind_storage(bindings.MASS)
        force = self._force.use()
        force.dispatch(*self._force_groups)
        shader_writes_visible()
        update = self._update.use_for_step(forcing, length)
        update.dispatch(self._update_groups)
        shader_writes_visible()

    def delete(self) -> None:
        """Give the passes and their buffers back."""
        self._force.delete()
        self._update.delete()
        self._forces.delete()
        self._masses.delete()
