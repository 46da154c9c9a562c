# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

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
