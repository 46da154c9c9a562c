# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The momenta of a cloth that nothing holds are given back to it after a substep."""

from cloth_sim_ros.sim.device.layout import choose_layout
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.modes.free_motion import FreeMotion
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
import numpy as np
from springs import SPRINGS

STILL = Forcing((0.0, 0.0, 0.0))


def test_a_substep_that_was_solved_badly_keeps_both_momenta(context):
    """A cloth in free fall would drift or turn by what the solver leaves over."""
    scene = Scene({**SPRINGS, 'rows': 7, 'cols': 6, 'pins': ['none'], 'start.z': 0.0})
    layout = choose_layout(scene, context)
    random = np.random.default_rng(1)
    before = scene.start_positions().astype(float)
    before += 0.05 * random.standard_normal(before.shape)
    velocities = np.cross([1.0, -2.0, 3.0], before) + [0.3, 0.2, -0.1]
    state = State(layout, before, scene.pinned_nodes())
    state.write(before, velocities)
    motion = FreeMotion(scene, layout)
    length = 0.02
    motion.aim_at(state, STILL, STILL, length)
    wrong = velocities + 0.5 * random.standard_normal(before.shape) + [0.2, 0.1, 0.3]
    state.write(before + length * wrong, wrong)
    motion.restore(state, STILL, length)
    after, moved = state.read_velocities().astype(float), state.read_positions().astype(float)
    scale = np.abs(velocities).sum()
    np.testing.assert_allclose(
        after.sum(axis=(0, 1)), velocities.sum(axis=(0, 1)), atol=1e-6 * scale)
    np.testing.assert_allclose(
        np.cross(moved, after).sum(axis=(0, 1)), np.cross(before, velocities).sum(axis=(0, 1)),
        atol=1e-6 * scale)
    # Nodes come to where their velocities take them.
    np.testing.assert_allclose(moved - before, length * after, atol=1e-6)
    motion.delete()
    state.delete()
