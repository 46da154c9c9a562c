# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Several substeps of small cloths in one dispatch, where a dispatch costs more than a substep."""

from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.low_parts import needs_low_parts
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State

# Sides of a tile [nodes]: 32 x 32 nodes fill the 32 KiB of shared memory and the 1,024 invocations
# that GL 4.3 grants a workgroup.
_SIDES = (16, 32)


class SpringTiles:
    """
    The pass mass_spring_tile.comp: a workgroup for each cloth.

    Overlapping tiles of larger cloths gained nothing (docs/notes/gpu/nvidia_h200.md).
    """

    def __init__(self, scene: Scene, layout: Layout) -> None:
        """Compile the pass."""
        rows = layout.cloth_rows or layout.rows
        side = next(side for side in _SIDES if max(rows, layout.cols) <= side)
        self._cloths = -(-layout.rows // layout.period)
        self._program = SceneProgram('mass_spring_tile.comp', scene, layout, {'TILE_SIDE': side})
        self._program.use()

    @staticmethod
    def can_run(scene: Scene, layout: Layout) -> bool:
        """Return whether a cloth fits into a tile, and springs are all that it is made of."""
        return (
            layout.kind == 'fused' and max(scene.rows, scene.cols) <= _SIDES[-1]
            and not (scene.has_rigidity or scene.has_bending_damping or scene.has_air
                     or scene.has_contact or needs_low_parts(scene)))

    def substeps(self, state: State, forcing: Forcing, length: float, count: int) -> None:
        """Step ``state`` on ``count`` times by ``length`` [s], under one load on all nodes."""
        program = self._program.use_for_step(forcing, length, length)
        program.set_int('substeps', count)
        state.bind_in()
        state.bind_out()
        program.dispatch(1, self._cloths)
        shader_writes_visible()
        state.swap()

    def delete(self) -> None:
        """Free the pass."""
        self._program.delete()
