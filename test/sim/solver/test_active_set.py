# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How soon it is known what touches a collider, and with how much friction."""

from contextlib import closing

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from springs import SPRINGS


def test_friction_of_what_slides_is_found_in_few_solves(context):
    """Nodes that slide on would be taken to stick in each substep, and be found out by solves."""
    scene = Scene({
        **SPRINGS, 'mode': 'constraint', 'rows': 16, 'cols': 16, 'areal_density': 0.15,
        'pins': ['none'], 'start.pose': 'horizontal', 'start.z': 0.2,
        'colliders.names': ['ball'], 'colliders.ball.shape': 'sphere',
        'colliders.ball.size': [0.15], 'colliders.ball.friction': 0.3})
    substeps = solves = sliding = 0
    with closing(Simulation(scene, context=context)) as simulation:
        simulation.advance(0.15)
        while simulation.time < 0.45:
            simulation.step()
            substeps += simulation.substeps
            seen = simulation.snapshot()
            solves += seen.solves
            sliding = max(sliding, seen.sliding_nodes)
    print(f'measured {solves / substeps:.2f} of 6 allowed: solves in each of {substeps} substeps')
    assert sliding > 0
    assert solves <= 6.0 * substeps
