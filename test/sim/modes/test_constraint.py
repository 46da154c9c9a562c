# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Settings and statistics of the constraint mode."""

import math

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from momenta import momenta
import numpy as np
import pytest
from springs import SPRINGS

SCENE = {'mode': 'constraint', 'rows': 12, 'cols': 9, 'dt': 0.01}


@pytest.fixture
def simulate(context):
    """Return a function from scene values to a simulation, which ends with the test."""
    opened = []

    def start(**values):
        opened.append(Simulation(Scene({**SPRINGS, **SCENE, **values}), context=context))
        return opened[-1]

    yield start
    for simulation in opened:
        simulation.close()


def test_solves_are_told(simulate):
    """People would not learn what a step took, or think a step good that is not."""
    simulation = simulate()
    assert simulation.snapshot().solver_iterations == 0
    simulation.step(5)
    snapshot = simulation.snapshot()
    assert 0 < snapshot.solver_iterations < 60
    assert 0.0 < snapshot.solver_residual <= simulation.scene['solver.tolerance']
    assert snapshot.solver_reached
    assert snapshot.solves == 2 * snapshot.substeps
    assert 0.0 < snapshot.mean_iterations <= snapshot.solver_iterations


def test_a_residual_that_was_not_reached_is_told(simulate):
    """A step that the solver gave up on would look like any other."""
    simulation = simulate(**{'solver.max_iterations': 1, 'solver.tolerance': 1e-4})
    simulation.step(5)
    snapshot = simulation.snapshot()
    assert snapshot.solver_iterations == 1
    assert snapshot.solver_residual > 1e-4
    assert not snapshot.solver_reached


def test_preconditioners_agree(simulate):
    """The result depends on how the linear system is solved."""
    ends = []
    for preconditioner in ('multigrid', 'block_jacobi'):
        simulation = simulate(**{
            'solver.preconditioner': preconditioner, 'solver.tolerance': 1e-6,
            'solver.max_iterations': 2000})
        simulation.step(20)
        ends.append(simulation.snapshot().positions)
    np.testing.assert_allclose(*ends, atol=2e-5)


def test_without_edges_nodes_fall_freely(simulate):
    """Edges that the scene leaves out still act."""
    simulation = simulate(**{'constraint.hard': []})
    simulation.step(30)
    snapshot = simulation.snapshot()
    free = ~simulation.pinned_nodes()
    np.testing.assert_allclose(
        snapshot.positions[free][:, 2], 1.0 - 9.81 * 0.01**2 * 30 * 31 / 2.0, rtol=1e-4)


def test_soft_springs_stretch_as_they_must(simulate):
    """Implicit springs do not come to rest where explicit ones do."""
    values = {
        'rows': 5, 'cols': 1, 'pins': ['top_left'], 'start.pose': 'hanging', 'node_mass': 0.01,
        'constraint.hard': [], 'constraint.springs': ['structural', 'bend'],
        'stiffness.bend': 0.0, 'damping.bend': 0.0, 'damping.structural': 1.0,
        'stiffness.structural': 20.0}
    simulation = simulate(**values)
    simulation.advance(4.0)
    down = -np.diff(simulation.snapshot().positions[:, 0, 2].astype(float))
    below = 0.01 * 9.81 * np.arange(4, 0, -1)
    np.testing.assert_allclose(down, 0.25 + below / 20.0, rtol=1e-4)


def test_a_family_is_hard_or_a_spring():
    """It would be silently one of the two."""
    with pytest.raises(ClothSimError, match='bend edges are in constraint.hard and in constr'):
        Scene({**SPRINGS, 'constraint.hard': ['bend'], 'constraint.springs': ['shear', 'bend']})
    with pytest.raises(ClothSimError, match='constraint.hard must be one of structural, shear'):
        Scene({**SPRINGS, 'constraint.hard': ['warp']})


def test_no_step_is_too_long(simulate):
    """A tight cloth would blow up in long steps, or not be reported as less exact in them."""
    simulation = simulate(**{'auto_substeps': False, 'dt': 0.05})
    simulation.push((0.0, 0.0, -30.0), duration=0.5)
    simulation.advance(2.0)
    snapshot = simulation.snapshot()
    assert simulation.stability_limit == math.inf
    assert snapshot.stability_margin > 1.0
    assert np.abs(snapshot.velocities).max() < 10.0


@pytest.mark.parametrize('steps', [
    1_000, pytest.param(10_000, marks=pytest.mark.long)])
def test_a_free_cloth_keeps_its_momenta(simulate, steps):
    """What the solver leaves over, or a second solve, drives the cloth or turns it."""
    simulation = simulate(**{
        'pins': ['none'], 'gravity': [0.0, 0.0, 0.0], 'dt': 0.005, 'start.jitter': 0.1})
    positions = simulation.snapshot().positions.astype(float)
    random = np.random.default_rng(1)
    spin = np.cross([0.7, 1.5, 2.2], positions - positions.mean(axis=(0, 1)))
    simulation.set_state(
        positions, spin + [0.3, 0.2, -0.1] + 0.3 * random.normal(size=positions.shape))
    before = momenta(simulation.snapshot())
    simulation.step(steps)
    after = momenta(simulation.snapshot())
    assert simulation.measure().max_strain < 0.01
    linear = np.abs(after[0] - before[0]).max() / before[2]
    angular = np.abs(after[1] - before[1]).max() / before[3]
    print(f'measured {linear:.1e} of 1e-6 and {angular:.1e} of 5e-6 allowed: {steps} steps')
    assert linear <= 1e-6
    assert angular <= 5e-6


def test_gravity_and_pushes_move_a_free_cloth(simulate):
    """A free cloth keeps a momentum that forces should change."""
    simulation = simulate(pins=['none'], **{'start.jitter': 0.1})
    simulation.push(
        (0.5, 0.0, 1.0), duration=0.055, region='sphere', center=(0.3, 0.2, 1.0), radius=0.4)
    simulation.step(20)
    snapshot = simulation.snapshot()
    mass = simulation.scene.node_mass
    momentum = mass * snapshot.velocities.sum(axis=(0, 1), dtype=float)
    weight = 0.2 * np.array([0.0, 0.0, -9.81])
    np.testing.assert_allclose(
        momentum, 0.2 * weight + 0.055 * np.array([0.5, 0.0, 1.0]), atol=1e-6)


@pytest.mark.parametrize(('speed', 'solves'), [(0.0, 1), (3.0, 2)])
def test_a_further_solve_mends_more_than_rounding(simulate, speed, solves):
    """A cloth at rest would pay for solves of noise, or lengths of one that swings be off."""
    simulation = simulate(**{
        'areal_density': 0.15, 'air.density': 1.225, 'start.pose': 'hanging',
        'pins': ['top_edge'], 'stiffness.bend': 0.0, 'damping.bend': 0.0})
    simulation.advance(0.5)
    positions = simulation.positions().astype(float)
    depth = 1.0 - positions[..., 2:] / positions[..., 2].max()
    simulation.set_state(positions, speed * depth * (0.0, 1.0, 0.0))
    for _ in range(5):
        simulation.step()
        snapshot = simulation.snapshot()
        assert snapshot.solves == solves * snapshot.substeps
        assert snapshot.max_strain < 1e-3
