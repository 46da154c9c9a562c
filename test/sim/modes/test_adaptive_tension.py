# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The tensions that mode adaptive reports."""

from contextlib import closing

from cloth_sim_ros.sim.held.pin_forces import spring_tension
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest

ROWS, COLS = 8, 6
# A limit that is passed soon, and one substep, so that two looks have all that happens between.
SCENE = {
    'mode': 'adaptive', 'rows': ROWS, 'cols': COLS, 'adaptive.threshold': 0.03, 'dt': 2e-3,
    'auto_substeps': False, 'stiffness.structural': 20.0, 'stiffness.shear': 15.0,
    'stiffness.bend': 2.0, 'pins': ['top_left', 'top_right', '4,3']}


def pull_on_nodes(positions, tension):
    """Return the sum of what the edges of each node pull it with [N]."""
    total = np.zeros((ROWS, COLS, 3))
    for kind in EDGE_KINDS:
        starts, ends = kind.everywhere(ROWS, COLS)
        d = positions[ends].astype(float) - positions[starts]
        pull = tension[(*starts, kind.number)] / np.linalg.norm(d, axis=-1)
        total[starts] += pull[..., None] * d
        total[ends] -= pull[..., None] * d
    return total


def springs_of(scene, look):
    """Return the tension of the springs alone."""
    return spring_tension(scene, look.positions, look.velocities)


def paper_pull(scene, before, after):
    """Return what pulled edges back in a step, and the springs where nothing did."""
    held = after.tension != springs_of(scene, after)
    return np.where(held, after.tension, springs_of(scene, before))


def test_paper_tensions_match_the_motion(context):
    """A tension would be reported for the wrong edge, or differ from the force applied."""
    scene = Scene({**SCENE, 'adaptive.scheme': 'paper'})
    with closing(Simulation(scene, context=context)) as simulation:
        simulation.advance(0.35)
        for _ in range(5):
            before = simulation.snapshot(tension=True)
            simulation.step()
            after = simulation.snapshot(tension=True)
            assert after.substeps == 1
            # Beyond the springs' own, on both diagonals too.
            held = after.tension != springs_of(scene, after)
            assert held[..., :4].any(axis=(0, 1)).all() and not held[..., 4:].any()
            force = pull_on_nodes(before.positions, paper_pull(scene, before, after))
            force += scene.node_mass * np.array(scene['gravity'])
            gained = scene.node_mass / SCENE['dt'] * (
                after.velocities.astype(float) - before.velocities)
            free = ~scene.pinned_nodes()
            np.testing.assert_allclose(
                gained[free], force[free], rtol=0.0, atol=1e-4 * np.abs(force).max())


@pytest.mark.parametrize('scheme', ['constraint', 'paper'])
def test_tension_within_the_limit_is_the_springs(context, scheme):
    """A past limit force, or one of the mode before, would still be reported."""
    scene = Scene({**SCENE, 'adaptive.scheme': scheme})
    with closing(Simulation(scene, context=context)) as simulation:
        simulation.advance(0.1)
        for look in (simulation.reset, lambda: simulation.set_mode('mass_spring')):
            look()
            snapshot = simulation.snapshot(tension=True)
            assert np.array_equal(snapshot.tension, springs_of(scene, snapshot))
