# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Elastic energy is what edges store by the law of the present mode, and nothing else."""

from cloth_sim_ros.reference.edge_law import spring_law
from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
from cloth_sim_ros.sim.model.materials import WARP
import numpy as np
import pytest

_STILL = {'gravity': [0.0, 0.0, 0.0], 'pins': ['none']}
_STIFF = {
    'stiffness.structural': [300.0, 500.0], 'stiffness.shear': 70.0, 'stiffness.bend': 20.0}
# What is hard, and what is a spring, in mode constraint.
_EDGES = {
    'hard edges alone': (['structural', 'shear'], []),
    'bend springs': (['structural', 'shear'], ['bend']),
    'hard structural edges': (['structural'], ['shear', 'bend']),
    'springs alone': ([], ['structural', 'shear', 'bend']),
}


def _energies_of_stretched(scene, factor):
    """Return the energy of each family [J] in a level cloth stretched along its rows."""
    rows, cols = scene.rows, scene.cols
    dx, dy = scene.spacing
    longer = {
        'structural': (rows * (cols - 1), (factor - 1.0) * dx),
        'shear': (2 * (rows - 1) * (cols - 1), np.hypot(factor * dx, dy) - np.hypot(dx, dy)),
        'bend': (rows * (cols - 2), 2.0 * (factor - 1.0) * dx),
    }
    return {
        family: 0.5 * scene.stiffness(family, WARP) * count * extension**2
        for family, (count, extension) in longer.items()}


@pytest.mark.parametrize('edges', _EDGES.values(), ids=_EDGES)
def test_it_is_that_of_the_edges_of_the_mode(simulate, any_mode, edges, within):
    """Edges that the mode leaves out would hold energy; hard ones, more than they can give."""
    hard, springs = edges
    simulation = simulate({
        'rows': 7, 'cols': 9, 'mode': any_mode, 'constraint.hard': hard,
        'constraint.springs': springs, **_STILL, **_STIFF})
    positions = simulation.scene.rest_positions() * (1.05, 1.0, 1.0)
    simulation.set_state(positions, np.zeros_like(positions))
    energies = _energies_of_stretched(simulation.scene, 1.05)
    expected = sum(
        energy for family, energy in energies.items()
        # A cloth that comes stretched has its hard edges closed in on, and springs until then.
        if any_mode != 'constraint' or family in hard + springs)
    scale = sum(energies.values())
    for seen in (simulation.measure(), simulation.snapshot()):
        within('elastic energy, over that of all families',
               abs(seen.elastic_energy - expected) / scale, 1e-5)
        assert seen.total_energy == seen.elastic_energy


# With harder edges, a cloth as stretched as this one settles first.
@pytest.mark.parametrize('strain', [0.008, 0.0045, 0.1])
def test_a_hard_edge_stores_what_it_takes_to_stretch_it(simulate, within, strain):
    """A cloth that is caught would seem to lose what its hard edges give back."""
    simulation = simulate({
        'rows': 7, 'cols': 9, 'mode': 'constraint', 'constraint.strain': strain,
        'areal_density': 0.3, **_STILL, **_STIFF})
    scene = simulation.scene
    positions = scene.rest_positions() * (1.005, 1.0, 1.0)
    simulation.set_state(positions, np.zeros_like(positions))
    # Pulls with L0 / E times the strain; few lines share the weight.
    pull = 0.3 * 9.81 / strain / (0.03 * 7)
    dx, dy = scene.spacing
    along = 0.5 * pull * 0.005**2 * dx * 7 * 8
    rest = np.hypot(dx, dy)
    across = 0.5 * pull * (np.hypot(1.005 * dx, dy) - rest)**2 / rest * 2 * 6 * 8
    # A length of 0.1 m is rounded by 1e-8 of it or so.
    within('elastic energy, relative to the formula',
           abs(simulation.measure().elastic_energy / (along + across) - 1.0), 2e-5)


def _hangs_at_limit(simulate, scheme, gravity):
    """Return snapshot, stretch [m] and mass of the lower one of two nodes at rest [kg]."""
    simulation = simulate({
        'rows': 1, 'cols': 2, 'width': 0.5, 'mode': 'adaptive', 'adaptive.scheme': scheme,
        'adaptive.threshold': 0.05, 'areal_density': 4.0, 'gravity': [gravity, 0.0, 0.0],
        'pins': ['top_left'], 'dt': 0.01, 'stiffness.structural': 1.0,
        'damping.structural': 2.0})
    simulation.advance(3.0)
    seen = simulation.snapshot()
    assert seen.active_constraints == 1
    stretch = float(seen.positions[0, 1, 0] - seen.positions[0, 0, 0]) - 0.5
    return seen, stretch, simulation.scene.node_mass


@pytest.mark.parametrize('gravity', [10.0, 1000.0])
def test_an_edge_at_its_limit_stores_that_too(simulate, within, gravity):
    """A cloth that is caught at its limit would gain energy when it swings back."""
    seen, stretch, mass = _hangs_at_limit(simulate, 'whole', gravity)
    # At rest, spring and limit carry one node. From the limit on its pull grows from nothing, over
    # 0.004 of strain, to what it is if an edge that carries both is a strain of 0.002 past 0.052.
    width = 0.002 * 0.5
    stiffness = mass * 2 * 9.81 / 0.002 / 0.03 / 0.5
    pulled = (mass * gravity - 1.0 * stretch) / stiffness
    is_near = pulled < width
    assert is_near == (gravity == 10.0)
    beyond = 2.0 * np.sqrt(pulled * width) - width if is_near else pulled
    stored = (beyond + width)**3 / (12.0 * width) if is_near else (
        0.5 * beyond**2 + width**2 / 6.0)
    assert stretch == pytest.approx(0.052 * 0.5 + beyond, abs=2e-7)
    within('elastic energy, relative to the formula', abs(
        seen.elastic_energy / (0.5 * stretch**2 + stiffness * stored) - 1.0), 1e-3)


@pytest.mark.parametrize('scheme', ['list', 'lattice'])
@pytest.mark.parametrize('gravity', [10.0, 1000.0])
def test_an_edge_that_impulses_hold_stores_nothing(simulate, within, scheme, gravity):
    """Energy would change when the whole cloth is solved for instead of its edges."""
    seen, stretch, mass = _hangs_at_limit(simulate, scheme, gravity)
    # An edge that carries both nodes is a strain of 0.03 of 0.002 past its limit.
    stiffness = mass * 2 * 9.81 / 0.002 / 0.03 / 0.5
    beyond = (mass * gravity - 1.0 * stretch) / stiffness
    # Rounds end at 1e-5 of the distance that a node falls in a substep.
    within('stretch, off that beyond the limit [m]', abs(stretch - 0.05 * 0.5 - beyond),
           2e-7 + 1e-5 * gravity * 0.01**2)
    within('elastic energy, relative to that of the spring',
           abs(seen.elastic_energy / (0.5 * stretch**2) - 1.0), 1e-5)


@pytest.mark.parametrize('jitter', [0.003, 0.1])
def test_the_reference_counts_the_same(simulate, within, jitter):
    """The oracle would hold the device to energies of other edges."""
    values = {
        'rows': 7, 'cols': 9, 'mode': 'constraint', 'constraint.springs': ['bend'],
        'start.jitter': jitter, **_STIFF}
    simulation = simulate(values)
    oracle = ImplicitCloth(simulation.scene)
    lengths = oracle.law.edges.lengths(oracle.positions.reshape(-1, 3))
    elastic = oracle.law.energy(lengths)
    if jitter > 0.01:
        # Until its limit has closed in, a stretched cloth is one of springs.
        elastic = spring_law(simulation.scene).energy(
            lengths)
    assert elastic > 0.0
    within('elastic energy of the start, relative to the reference',
           abs(simulation.measure().elastic_energy / elastic - 1.0), 1e-5)


def test_a_falling_chain_gains_no_energy(simulate, within):
    """Bend springs that the mode omits would be reported as energy."""
    simulation = simulate({
        'rows': 10, 'cols': 1, 'mode': 'constraint', 'constraint.hard': ['structural'],
        'stiffness.bend': 1000.0, 'pins': ['top_left'], 'dt': 0.002})
    start = simulation.measure().total_energy
    most = start
    for _ in range(20):
        simulation.advance(0.05)
        most = max(most, simulation.measure().total_energy)
    fall = simulation.scene.node_mass * simulation.scene.node_count * 9.81
    within('energy gained by a chain that falls for 1 s, over M g L', (most - start) / fall, 0.01)


def test_a_switch_changes_no_energy_but_that_of_the_edges(simulate, within):
    """A switch would look like a blow-up, or hide one."""
    simulation = simulate({
        'rows': 10, 'cols': 1, 'mode': 'constraint', 'constraint.hard': ['structural'],
        'stiffness.bend': 1000.0, 'pins': ['top_left'], 'dt': 0.002})
    simulation.advance(0.5)
    before = simulation.snapshot()
    simulation.set_mode('mass_spring')
    after = simulation.snapshot()
    assert after.state_sha256 == before.state_sha256
    assert after.kinetic_energy == before.kinetic_energy
    assert after.gravitational_energy == before.gravitational_energy
    chain = before.positions[:, 0].astype(float)
    scene = simulation.scene
    springs = sum(
        0.5 * scene.stiffness(family) * np.sum((
            np.linalg.norm(chain[step:] - chain[:-step], axis=1) - step * scene.spacing[1])**2)
        for family, step in (('structural', 1), ('bend', 2)))
    within('elastic energy, relative to that of the springs',
           abs(after.elastic_energy / springs - 1.0), 1e-5)
    simulation.set_mode('constraint')
    assert simulation.measure().total_energy == before.total_energy


def test_hard_edges_without_springs_are_observed(simulate, within):
    """Hard edges that are no springs anywhere could be off by anything, and nobody would know."""
    simulation = simulate({
        'rows': 5, 'cols': 5, 'mode': 'constraint', **_STILL,
        **{f'{what}.{family}': 0.0 for what in ('stiffness', 'damping')
           for family in ('structural', 'shear', 'bend')}})
    positions = simulation.scene.rest_positions() * (1.005, 1.0, 1.0)
    simulation.set_state(positions, np.zeros_like(positions))
    seen = simulation.measure()
    within('largest strain, off 0.005', abs(seen.max_strain - 0.005), 1e-6)
    assert seen.elastic_energy > 0.0
