# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Elastic energy is that of what the present mode models as springs, and of nothing else."""

from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
import numpy as np
import pytest

_STILL = {'gravity': [0.0, 0.0, 0.0], 'pins': ['none']}
_STIFF = {
    'stiffness.structural': 300.0, 'stiffness.shear': 70.0, 'stiffness.bend': 20.0}
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
        family: 0.5 * scene.stiffness(family) * count * extension**2
        for family, (count, extension) in longer.items()}


@pytest.mark.parametrize('edges', _EDGES.values(), ids=_EDGES)
def test_it_is_that_of_the_springs_of_the_mode(simulate, any_mode, edges, within):
    """Hard edges, or edges that the mode leaves out, would hold energy that nothing can give."""
    hard, springs = edges
    simulation = simulate({
        'rows': 7, 'cols': 9, 'mode': any_mode, 'constraint.hard': hard,
        'constraint.springs': springs, **_STILL, **_STIFF})
    positions = simulation.scene.rest_positions() * (1.05, 1.0, 1.0)
    simulation.set_state(positions, np.zeros_like(positions))
    energies = _energies_of_stretched(simulation.scene, 1.05)
    expected = sum(
        energy for family, energy in energies.items()
        if any_mode != 'constraint' or family in springs)
    scale = sum(energies.values())
    for seen in (simulation.measure(), simulation.snapshot()):
        within('elastic energy, over that of all families',
               abs(seen.elastic_energy - expected) / scale, 1e-5)
        assert seen.total_energy == seen.elastic_energy


def test_the_reference_counts_the_same(simulate, within):
    """The oracle would hold the device to energies of other edges."""
    values = {
        'rows': 7, 'cols': 9, 'mode': 'constraint', 'constraint.springs': ['bend'],
        'start.jitter': 0.1, **_STIFF}
    simulation = simulate(values)
    oracle = ImplicitCloth(simulation.scene)
    elastic = oracle.law.spring_energy(
        oracle.law.edges.lengths(oracle.positions.reshape(-1, 3)))
    assert elastic > 0.0
    within('elastic energy of the start, relative to the reference',
           abs(simulation.measure().elastic_energy / elastic - 1.0), 1e-5)


def test_a_falling_chain_gains_no_energy(simulate, within):
    """Bend springs that the mode leaves out would be told as energy from nothing."""
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


def test_a_switch_changes_the_energy_by_that_of_the_springs(simulate, within):
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
    within('jump of the total energy, relative to the energy of the springs',
           abs((after.total_energy - before.total_energy) / springs - 1.0), 1e-5)
    simulation.set_mode('constraint')
    assert simulation.measure().total_energy == before.total_energy
