# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Several substeps of a small cloth in one dispatch, in shared memory, against one."""

from collections.abc import Iterator

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.device.layout import choose_layout
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.modes.mass_spring import OnePass
from cloth_sim_ros.sim.modes.spring_tiles import SpringTiles
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.study.speed import bench_scene
from gpu.clock import seconds_each
from gpu.section import FAULT
from gpu.section import Row
from gpu.section import Section
import numpy as np

_SUBSTEPS = 64


def same_bits(scene: Scene, context: Context) -> bool:
    """Return whether both ways lead to the same positions and velocities."""
    layout = choose_layout(scene, context, tuned=False)
    forcing = Forcing(scene['gravity'])
    found = []
    for passes in (OnePass(scene, layout), SpringTiles(scene, layout)):
        state = State(layout, scene.start_positions(), scene.pinned_nodes())
        passes.substeps(state, forcing, scene['dt'], _SUBSTEPS)
        found.append((state.read_positions(), state.read_velocities()))
        state.delete()
        passes.delete()
    return all(np.array_equal(one, other) for one, other in zip(*found))


def _measure(quick: bool) -> Iterator[Row]:
    context = Context(single_thread=True)
    turn = 0.02 if quick else 0.05
    for side in (12, 20) if quick else (8, 12, 16, 20, 24, 32):
        scene = bench_scene(side, {})
        layout = choose_layout(scene, context, tuned=False)
        forcing = Forcing(scene['gravity'])
        state = State(layout, scene.start_positions(), scene.pinned_nodes())

        def seconds(passes: OnePass | SpringTiles) -> float:
            found = seconds_each(
                lambda: passes.substeps(state, forcing, scene['dt'], _SUBSTEPS), context, turn)
            passes.delete()
            return found / _SUBSTEPS

        row: Row = {'side': side, 'one [us a substep]': 1e6 * seconds(OnePass(scene, layout))}
        row['all in one [us]'] = 1e6 * seconds(SpringTiles(scene, layout))
        state.delete()
        same = same_bits(scene, context)
        yield {**row, 'same bits': same, FAULT: '' if same else 'other bits'}
    context.close()


SECTION = Section('fused_substeps', 'Several substeps a dispatch', 40.0, _measure)
