# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How soon it is known which edges and faces press on a thin body, and how strongly."""

from contextlib import closing

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import pytest

ROD = {
    'mode': 'constraint', 'material.preset': 'trousers', 'width': 0.5, 'height': 0.5, 'rows': 17,
    'cols': 17, 'dt': 0.005, 'pins': ['none'], 'start.pose': 'horizontal', 'start.z': 0.02,
    'air.density': 0.0, 'damping.structural': 0.02, 'colliders.names': ['rod'],
    'colliders.rod.shape': 'capsule', 'colliders.rod.size': [0.01, 2.0],
    'colliders.rod.position': [0.25 / 16, 0.0, 0.0], 'colliders.rod.friction': 0.5,
    'colliders.rod.orientation': [0.5**0.5, 0.0, 0.0, 0.5**0.5]}


def test_what_presses_on_a_rod_is_found_in_few_solves(context):
    """Contacts would alternate, let go by one solve and held by the next."""
    substeps = solves = iterations = 0
    with closing(Simulation(Scene(ROD), context=context)) as simulation:
        simulation.advance(0.1)
        while simulation.time < 0.5:
            simulation.step()
            substeps += simulation.substeps
            seen = simulation.snapshot()
            assert seen.solver_reached
            solves += seen.solves
            iterations += seen.solves * seen.mean_iterations
    print(f'measured {solves / substeps:.2f} of 6 allowed: solves in each of {substeps} substeps')
    print(f'measured {iterations / solves:.2f} of 20 allowed: iterations of a solve')
    assert solves <= 6.0 * substeps
    assert iterations <= 20.0 * solves


def test_a_thin_body_far_away_changes_nothing(context):
    """Scenes would move otherwise, and take longer, by a body that they never meet."""
    found = []
    for features in (True, False):
        scene = Scene({**ROD, 'colliders.rod.position': [3.0, 0.0, -30.0],
                       'contact.features': features, 'pins': ['top_edge']})
        with closing(Simulation(scene, context=context)) as simulation:
            simulation.step(30)
            found.append(simulation.snapshot().state_sha256)
    assert found[0] == found[1]


@pytest.mark.parametrize('preconditioner', ['multigrid', 'block_jacobi'])
def test_both_preconditioners_hold_the_cloth(context, preconditioner):
    """What contacts add would be left out of one of them, and solves go astray."""
    scene = Scene({**ROD, 'solver.preconditioner': preconditioner})
    with closing(Simulation(scene, context=context)) as simulation:
        simulation.step(40)
        seen = simulation.snapshot()
        force = simulation.contact_forces()[0].force[2]
    assert seen.solver_reached
    assert seen.positions[..., 2].max() > 0.0
    assert force < -0.3 * scene.mass * 9.81
