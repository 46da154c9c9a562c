# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The constraint mode makes no energy, and follows links as rigid as its edges are hard."""

from cloth_sim_ros.reference.cloth import elastic_energy
from cloth_sim_ros.reference.edges import spring_sets
from cloth_sim_ros.validation.pendulums import distance_from_links
import numpy as np
import pytest

GRAVITY = 9.81
# Energy above the start, over M g L, by dt [s]. Half of it is that a velocity belongs to the
# middle of the substep before.
GAIN = {0.02: 0.04, 0.01: 0.02, 0.005: 0.01}
# Below it, of one link; more links are chaotic, and at 0.02 s they turn too fast for it.
LOSS = {0.02: 0.09, 0.01: 0.08, 0.005: 0.08}


def _chain(links: int, dt: float, **values) -> dict:
    return {'mode': 'constraint', 'rows': 1, 'cols': links + 1, 'width': 1.0, 'node_mass': 0.1,
            'pins': ['top_left'], 'dt': dt, **values}


@pytest.mark.parametrize(('links', 'dt'), [
    (1, 0.02), (3, 0.02),
    *(pytest.param(links, dt, marks=pytest.mark.long)
      for links, dt in ((2, 0.02), (1, 0.01), (2, 0.01), (3, 0.01), (1, 0.005), (2, 0.005),
                        (3, 0.005)))])
def test_a_chain_from_level_keeps_its_energy(simulate, within, links, dt):
    """A double pendulum would swing higher than it began, or come to rest without friction."""
    simulation = simulate(_chain(links, dt))
    start = simulation.measure()
    changes = []
    for _ in range(round(20.0 / dt)):
        simulation.step()
        now = simulation.measure()
        changes.append(now.kinetic_energy + now.gravitational_energy - start.gravitational_energy)
    weight = 0.1 * links * GRAVITY
    within('energy above the start, over M g L', max(changes) / weight, GAIN[dt])
    if links == 1 or dt <= 0.01:
        within('energy below the start, over M g L', -min(changes) / weight, LOSS[dt])


@pytest.mark.parametrize('links', [1, 2])
def test_converges_to_rigid_links(context, links):
    """The chain is not that of Lagrange's equations, to first order in dt."""
    errors = [distance_from_links(context, links, dt) for dt in (0.01, 0.005, 0.0025)]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    print(f'measured: {links} links off by {errors} m, orders {orders}')
    assert orders == pytest.approx(np.ones(2), abs=0.1)


@pytest.mark.parametrize('dt', [2e-4, pytest.param(2e-5, marks=pytest.mark.long)])
def test_a_crumpled_chain_has_the_energy_of_its_springs(simulate, within, dt):
    """A chain whose edges are off their length would be thrown by the edges that hold it."""
    simulation = simulate({
        **_chain(11, dt), 'node_mass': 0.003, 'gravity': [0.0, 0.0, 0.0], 'pins': ['none'],
        'start.jitter': 0.1})
    stored = elastic_energy(
        spring_sets(simulation.scene), simulation.snapshot().positions.astype(float))
    most = 0.0
    for _ in range(40):
        simulation.step(round(0.01 / dt))
        most = max(most, simulation.measure().kinetic_energy)
    within('kinetic energy over what the springs held', most / stored, 1.01)
    within('strain', simulation.measure().max_strain, 1e-3)


@pytest.mark.parametrize('dt', [0.066, 0.1])
def test_a_long_step_holds_lengths(simulate, within, dt):
    """Hard edges would be off by a third at a long dt, and nobody would know."""
    simulation = simulate({'mode': 'constraint', 'rows': 7, 'cols': 9, 'dt': dt})
    most = 0.0
    for _ in range(round(3.0 / dt)):
        simulation.step()
        most = max(most, simulation.measure().max_strain)
    within('strain', most, 0.05)
    assert simulation.snapshot().solver_reached


def test_pins_pulled_beyond_the_cloth_length(simulate, within):
    """Pins moved too far apart would pull with 1e5 N, and throw the cloth when they let go."""
    simulation = simulate({
        'mode': 'mass_spring', 'rows': 9, 'cols': 9,
        'areal_density': 0.1})
    simulation.move_pin(0, 8, (0.9, 0.5, 1.0), 0.5)
    simulation.advance(1.2)
    simulation.set_mode('constraint')
    simulation.step(200)
    held = simulation.snapshot(pin_forces=True)
    # lambda = (l / L0 - 1) L0 / E of the three edges at the corner that was moved.
    full = 0.1 * GRAVITY / 0.008 / (0.03 * 9)
    positions = held.positions.astype(float)
    pull = np.zeros(3)
    for row, col, rest in ((0, 7, 0.125), (1, 8, 0.125), (1, 7, 0.125 * np.sqrt(2.0))):
        edge = positions[row, col] - positions[0, 8]
        length = np.linalg.norm(edge)
        pull += full * (length / rest - 1.0) * edge / length
    corner = held.pin_forces.forces[held.pin_forces.nodes.tolist().index([0, 8])]
    assert np.linalg.norm(pull) > 100.0
    within('pin against its edges, relative',
           np.linalg.norm(corner - pull) / np.linalg.norm(pull), 0.02)
    within('kinetic energy [J]', held.kinetic_energy, 1.0)
