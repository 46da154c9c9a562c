# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Schemes list and lattice of the adaptive mode against the exact solution in float64.

Both make the same substeps of springs. They differ by rounding, by where the rounds of the device
end, and by edges that it does not list.
"""

from contextlib import closing

from cloth_sim_ros.reference.limited_cloth import LimitedSpringsReference
from cloth_sim_ros.sim.limits import limit_program
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from measured import within
import numpy as np
import pytest
from springs import SPRINGS

SCHEMES = ('list', 'lattice')
SCENE = {
    **SPRINGS, 'mode': 'adaptive', 'rows': 6, 'cols': 5, 'width': 0.8, 'height': 1.0,
    'start.pose': 'hanging', 'adaptive.threshold': 0.02, 'stiffness.structural': 2.0,
    'stiffness.shear': 2.0, 'stiffness.bend': 0.0, 'damping.bend': 0.0,
    'damping.structural': 1e-3, 'damping.shear': 1e-3, 'auto_substeps': False, 'dt': 0.002,
    'substeps': 2}
FORMS = {
    'one corner': {'pins': ['top_left']},
    'two corners': {'pins': ['top_left', 'top_right']},
    'limit of 10 %': {'pins': ['top_left'], 'adaptive.threshold': 0.1},
    'unequal cells': {'pins': ['top_left', 'top_right'], 'width': 1.7},
    'without shear': {'pins': ['top_left'], 'stiffness.shear': 0.0, 'damping.shear': 0.0},
    'a chain': {'pins': ['top_edge'], 'rows': 12, 'cols': 1},
    'damped': {'pins': ['top_left'], 'damping.structural': 0.05, 'damping.shear': 0.05},
    'bend springs': {'pins': ['top_left'], 'stiffness.bend': 10.0, 'damping.bend': 0.01},
}
STEPS = 10
# A coordinate near 1 m is rounded by 2^-25 m in each substep [m].
ROUNDING = 2.0**-24


def both(values, scheme, context, strain=0.97, speed=0.1):
    """
    Return the device and the reference with the same state.

    :param strain: of all edges, over the limit
    :param speed: standard deviation of the velocities [m/s]
    """
    scene = Scene({**SCENE, **values, 'adaptive.scheme': scheme})
    simulation = Simulation(scene, context=context)
    positions = (
        (1.0 + strain * scene['adaptive.threshold']) * scene.start_positions()
    ).astype(np.float32)
    velocities = np.random.default_rng(3).normal(0.0, speed, positions.shape).astype(np.float32)
    velocities[scene.pinned_nodes()] = 0.0
    simulation.set_state(positions, velocities)
    cloth = LimitedSpringsReference(scene)
    cloth.positions, cloth.velocities = positions.astype(float), velocities.astype(float)
    return closing(simulation), cloth


def step_both(simulation, cloth, tolerance):
    """
    Step both, and hold the device to the reference.

    :param tolerance: of a length in a substep [m]
    """
    h = cloth.dt / cloth.substeps
    held, steps = [], 0
    for _ in range(STEPS):
        simulation.step()
        cloth.step()
        steps += cloth.substeps
        snapshot = simulation.snapshot()
        assert snapshot.listed_substeps == simulation.substeps == cloth.substeps
        assert snapshot.solver_reached
        held.append(np.count_nonzero(np.linalg.norm(cloth.impulses, axis=1)))
        # A substep leaves an error of the tolerance in the lengths along a line of edges, from
        # which the next ones start.
        lines = max(cloth.scene.rows, cloth.scene.cols)
        off = (tolerance + 2.0 * ROUNDING) * lines
        within('positions [m]', np.abs(snapshot.positions - cloth.positions).max(),
               off * np.sqrt(steps))
        within('velocities [m/s]', np.abs(snapshot.velocities - cloth.velocities).max(),
               2.0 * off / h)
    return held


@pytest.fixture
def exact(monkeypatch):
    """Let the device make rounds up to the accuracy of float32."""
    monkeypatch.setattr(limit_program, '_LOOSE', 0.0)
    monkeypatch.setattr(limit_program, '_REDUCTION', (0.0, 0.0))
    monkeypatch.setattr(limit_program, '_TOLERANCE', 2e-3)


@pytest.mark.parametrize('scheme', SCHEMES)
@pytest.mark.parametrize(('form', 'start'), [
    *((form, {}) for form in FORMS), ('two corners', {'strain': -0.97})], ids=str)
def test_with_a_tight_tolerance(context, exact, scheme, form, start):
    """A limit, upper or lower, its direction, or what an edge beyond it may keep is wrong."""
    run, cloth = both(FORMS[form], scheme, context, **start)
    with run as simulation:
        h = cloth.dt / cloth.substeps
        held = step_both(simulation, cloth, 2e-3 * 9.81 * h**2)
    assert max(held) > 3


@pytest.mark.parametrize('scheme', SCHEMES)
def test_a_pin_that_moves(context, exact, scheme):
    """The velocity of a pin is not what an edge behind it follows."""
    run, cloth = both(FORMS['one corner'], scheme, context)
    with run as simulation:
        way = np.array([-0.3, 0.0, 0.4])
        simulation.move_pin(0, 0, cloth.positions[0, 0] + way, 0.2)
        cloth.move_pin(0, 0, 0.2 * way / 0.5)
        h = cloth.dt / cloth.substeps
        held = step_both(simulation, cloth, 2e-3 * 9.81 * h**2)
    assert max(held) > 3


@pytest.mark.parametrize('scheme', SCHEMES)
@pytest.mark.parametrize('form', ['one corner', 'two corners', 'limit of 10 %', 'a chain'])
def test_with_the_tolerance_of_the_scheme(context, scheme, form):
    """
    What rounds leave adds up, or an edge that is not listed passes its limit.

    While the cloth moves, rounds end at half of the first change of a length, up to a hundredth
    of the limit.
    """
    run, cloth = both(FORMS[form], scheme, context)
    with run as simulation:
        scene = cloth.scene
        loose = limit_program._LOOSE * scene['adaptive.threshold'] * min(scene.spacing)
        step_both(simulation, cloth, loose)


@pytest.mark.parametrize('scheme', SCHEMES)
@pytest.mark.parametrize('form', FORMS)
def test_pins_feel_springs_and_limits(context, exact, scheme, form):
    """The force at a pin lacks what a limit pulls, or counts it for another time."""
    run, cloth = both(FORMS[form], scheme, context)
    with run as simulation:
        h = cloth.dt / cloth.substeps
        pinned = cloth.scene.pinned_nodes()
        # Pin forces are kept from when they are first asked for.
        simulation.snapshot(pin_forces=True)
        for _ in range(STEPS):
            simulation.step()
            cloth.step()
            found = simulation.snapshot(pin_forces=True).pin_forces
            # Off by as much as the velocities are, of the mass of two nodes, and by springs.
            lines = max(cloth.scene.rows, cloth.scene.cols)
            off = (2e-3 * 9.81 * h**2 + 2.0 * ROUNDING) * lines
            within('force of a pin [N]', np.abs(
                found.forces + cloth.reactions[pinned]).max(),
                4.0 * off / h**2 * cloth.scene.node_mass)


@pytest.mark.parametrize('scheme', SCHEMES)
def test_impulses_keep_momentum(context, scheme):
    """An impulse acts on one end of an edge more than on the other."""
    values = {'pins': ['none'], 'gravity': [0.0, 0.0, 0.0], 'damping.structural': 0.0,
              'damping.shear': 0.0}
    run, cloth = both(values, scheme, context, speed=0.5)
    with run as simulation:
        before = simulation.snapshot().velocities.astype(float)
        held = 0
        for _ in range(50):
            simulation.step()
            held += simulation.snapshot().active_constraints
        after = simulation.snapshot().velocities.astype(float)
    assert held > 100
    within('change of momentum over that of all nodes',
           np.abs((after - before).sum(axis=(0, 1))).max() / np.abs(before).sum(), 1e-6)
