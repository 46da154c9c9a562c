# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The paper's mass-spring mode: forces in one pass (Tab. 1), then the update (Tab. 2)."""

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.modes.mass_spring import MassSpring
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
import numpy as np

# Nodes of a work group of the update [1], as in the paper.
_UPDATE_LOCAL = 1024
_FORCE_BYTES = 16  # of a node: a vec4


class TwoPasses:
    """Forces into a buffer (paper, Tab. 1), then the update (Tab. 2)."""

    def __init__(self, scene: Scene, layout: Layout) -> None:
        """Compile both passes and allocate the force and mass buffers."""
        self._force = SceneProgram('paper/force.comp', scene, layout)
        self._update = SceneProgram(
            'paper/update.comp', scene, layout, {'UPDATE_LOCAL': _UPDATE_LOCAL})
        self._recording_update = SceneProgram(
            'paper/update.comp', scene, layout, {'UPDATE_LOCAL': _UPDATE_LOCAL, 'HAS_HELD': 1})
        self._forces = Buffer(layout.stored * _FORCE_BYTES)
        self._masses = Buffer(np.full(layout.stored, scene.node_mass, dtype=np.float32))
        self._force_groups = layout.groups
        self._update_groups = -(-scene.node_count // _UPDATE_LOCAL)
        self._force.use()
        self._update.use()

    def substeps(self, state: State, forcing: Forcing, length: float, count: int) -> None:
        """Step ``state`` on ``count`` times by ``length`` [s]."""
        for _ in range(count):
            self.substep(state, forcing, length)

    def substep(self, state: State, forcing: Forcing, length: float) -> None:
        """Step ``state`` on by ``length`` [s], in place."""
        held_at = state.next_held_entry()
        state.bind_in()
        self._forces.bind_storage(bindings.FORCE)
        self._masses.bind_storage(bindings.MASS)
        force = self._force.use()
        force.dispatch(*self._force_groups)
        shader_writes_visible()
        state.bind_low_parts()
        if held_at < 0:
            update = self._update.use_for_step(forcing, length)
        else:
            update = self._recording_update.use_for_step(forcing, length)
            update.set_int('held_at', held_at)
        update.dispatch(self._update_groups)
        shader_writes_visible()

    def delete(self) -> None:
        """Release the passes and their buffers."""
        self._force.delete()
        self._update.delete()
        self._recording_update.delete()
        self._forces.delete()
        self._masses.delete()


class PaperMassSpring(MassSpring):
    """Springs in the paper's passes: ``layout: paper``."""

    @staticmethod
    def make_passes(scene: Scene, layout: Layout) -> TwoPasses:
        """Compile and return the paper's passes."""
        return TwoPasses(scene, layout)
