# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The constraint mode on the device against the float64 reference, which solves directly."""

from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from edge_places import edge_places
import numpy as np
import pytest
from springs import SPRINGS

ALL = ('structural', 'shear', 'bend')
BEND = {'stiffness.bend': 10.0, 'damping.bend': 0.01}
FORMS = {
    'one solve': {'constraint.newton_iterations': 1},
    'two solves': {},
    'three solves': {'constraint.newton_iterations': 3},
    'four solves': {'constraint.newton_iterations': 4},
    'three substeps': {'substeps': 3},
    'without gravity': {'gravity': [0.0, 0.0, 0.0]},
    'bend springs': {**BEND, 'constraint.springs': ['bend'], 'constraint.newton_iterations': 3},
    'implicit springs': {**BEND, 'constraint.hard': [], 'constraint.springs': ALL},
    'all hard': {'constraint.hard': ALL},
    'harder': {'constraint.strain': 0.004},
    'softer': {'constraint.strain': 0.05},
}
# No edge is off by more than 1 % at the start: beyond, the device takes lengths as they come.
SCENE = {
    **SPRINGS, 'mode': 'constraint', 'rows': 7, 'cols': 9, 'width': 1.3, 'dt': 0.005,
    'pins': ['top_left', '3,8'], 'solver.tolerance': 1e-6,
    'solver.max_iterations': 400, 'auto_substeps': False,
    'pushes.start': [0.0, 0.01], 'pushes.duration': [0.03, 0.05],
    'pushes.force': [0.2, 0.0, 3.0, 0.0, 1.0, 0.0],
    'pushes.center': [0.0, 0.0, 0.0, 0.0, 0.0, 1.0], 'pushes.radius': [0.0, 0.35]}


def start_rolled(simulation: Simulation) -> ImplicitCloth:
    """
    Give the cloth a rolled shape and random velocities, and return the reference with the same.

    Chords of the roll are shorter than its arcs: edges by up to 0.3 %, two in a row by 1.2 %.
    """
    scene = simulation.scene
    rest, radius = scene.rest_positions(), 0.6
    turn = rest[..., 0] / radius
    positions = np.stack([
        radius * np.sin(turn), rest[..., 1], rest[..., 2] + radius * (1.0 - np.cos(turn))],
        axis=-1).astype(np.float32)
    velocities = np.random.default_rng(3).normal(0.0, 0.5, rest.shape).astype(np.float32)
    velocities[scene.pinned_nodes()] = 0.0
    simulation.set_state(positions, velocities)
    oracle = ImplicitCloth(scene)
    oracle.positions, oracle.velocities = positions.astype(float), velocities.astype(float)
    return oracle


@pytest.mark.parametrize('loads', ['texture', 'storage'])
@pytest.mark.parametrize('form', FORMS)
def test_steps_and_tensions(simulate, within, form, loads):
    """
    A step on the device differs from the law by more than float32 rounding.

    A position near 1 m is rounded by 2^-25 m, an edge by twice that, over h for velocities, over E
    for tensions. Six steps and the solves, which stop at 1e-6 of the change, make it some times as
    much.
    """
    simulation = simulate({**SCENE, **FORMS[form], 'loads': loads})
    oracle = start_rolled(simulation)
    for _ in range(6):
        simulation.step()
        oracle.step()
    snapshot = simulation.snapshot(tension=True)
    assert snapshot.solver_reached
    assert snapshot.solver_residual <= 1e-6
    rounding = 2.0**-24
    within('positions [m]', np.abs(snapshot.positions - oracle.positions).max(), 20.0 * rounding)
    within('velocities [m/s]', np.abs(snapshot.velocities - oracle.velocities).max(),
           20.0 * rounding / oracle.dt * simulation.substeps)
    found = snapshot.tension[edge_places(oracle.law.edges, oracle.scene.cols)]
    hardest = np.max(oracle.law.slope(oracle.law.edges.rest_length))
    within('tensions [N]', np.abs(found - oracle.tension).max(),
           20.0 * rounding * hardest)
    assert np.count_nonzero(snapshot.tension) == np.count_nonzero(oracle.tension)


@pytest.mark.parametrize('refine', [1, 3])
def test_substeps_are_those_of_the_reference(simulate, within, refine):
    """Substeps are not chosen from the turn of edges, or steps of other lengths do not fit."""
    simulation = simulate({**SCENE, 'auto_substeps': True, 'dt': 0.02, 'refine': refine})
    oracle = start_rolled(simulation)
    chosen = []
    for _ in range(8):
        simulation.step()
        oracle.step()
        chosen.append((simulation.substeps, oracle.report.substeps))
    assert [both[0] for both in chosen] == [both[1] for both in chosen]
    assert len(set(chosen)) > 1
    within('positions [m]',
           np.abs(simulation.snapshot().positions - oracle.positions).max(), 2e-5)


def test_the_step_stays_within_its_most_substeps(simulate):
    """A violent push makes a step take forever."""
    values = {
        **SCENE, 'auto_substeps': True, 'dt': 0.02, 'constraint.max_substeps': 3,
        'pushes.force': [0.0, 0.0, 500.0, 0.0, 1.0, 0.0]}
    simulation, oracle = simulate(values), ImplicitCloth(Scene(values))
    simulation.step(3)
    oracle.step(3)
    assert simulation.substeps == oracle.report.substeps == 3
