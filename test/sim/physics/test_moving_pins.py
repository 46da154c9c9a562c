# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""A cloth whose pins move, against closed forms, another frame of reference and the oracle."""

from time import process_time

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
import numpy as np
import pytest

VALUES = {'rows': 11, 'cols': 14, 'width': 1.3, 'dt': 0.003, 'start.jitter': 0.02,
          'damping.structural': 0.03}
# For the solver of mode constraint.
EXACT = {'solver.tolerance': 1e-6, 'solver.max_iterations': 400}
# Light and limp, with a limit of 1 %: a towel.
TOWEL = {
    'mode': 'adaptive', 'adaptive.threshold': 0.01, 'stiffness.structural': 5.0,
    'stiffness.shear': 5.0, 'stiffness.bend': 0.5, 'damping.structural': 1e-3,
    'damping.shear': 1e-3, 'damping.bend': 1e-4, 'dt': 0.01}


def drive(oracle, node, origin, target, speed, steps):
    """Step the oracle with a pin that goes from ``origin`` to ``target`` meanwhile."""
    way = np.subtract(target, origin)
    length = np.linalg.norm(way)
    for step in range(steps):
        begin, end = (
            np.minimum(speed * (step + later) * oracle.dt, length) for later in (0, 1))
        oracle.move_pin(*node, way / length * (end - begin) / oracle.dt)
        oracle.step()


def shake(simulation, seconds):
    """Shake the pins by +-5 cm at 2 Hz; return the largest strain after each step."""
    start = simulation.snapshot().positions.astype(float)
    pins = np.argwhere(simulation.pinned_nodes()).tolist()
    strains, substeps, place = [], [], np.zeros(3)
    begin = process_time()
    for step in range(round(seconds / simulation.dt)):
        turn = 4.0 * np.pi * (step + 1) * simulation.dt
        goal = 0.05 * np.array([np.sin(turn), 0.0, 0.5 * (1.0 - np.cos(turn))])
        for row, col in pins:
            simulation.move_pin(
                row, col, start[row, col] + goal,
                np.linalg.norm(goal - place) / simulation.dt)
        place = goal
        simulation.step()
        snapshot = simulation.snapshot()
        assert snapshot.finite
        strains.append(snapshot.max_strain)
        substeps.append(snapshot.substeps)
    print(f'measured: {np.mean(substeps):.0f} substeps a step, at most {max(substeps)}, '
          f'{seconds / (process_time() - begin):.3f} of real time by processor time')
    return np.array(strains)


def test_a_cloth_that_moves_as_a_whole_does_not_know(simulate, within, any_mode, layout):
    """A pin's velocity is not seen by damping or constraints, or its way differs from it."""
    velocity = np.array([1.5, -0.5, 0.8])
    values = {**VALUES, **EXACT, 'mode': any_mode, 'layout': layout, 'pins': ['top_edge']}
    still, moving = simulate(values), simulate(values)
    start = still.snapshot().positions.astype(float)
    moving.set_state(start, np.broadcast_to(velocity, start.shape))
    for row, col in np.argwhere(moving.pinned_nodes()).tolist():
        moving.move_pin(row, col, start[row, col] + 3.0 * velocity, np.linalg.norm(velocity))
    still.step(25)
    moving.step(25)
    miss = moving.snapshot().positions - velocity * moving.time - still.snapshot().positions
    within('cloth in a moving frame [m]', np.abs(miss).max(), 1e-5)
    assert np.abs(still.snapshot().positions - start).max() > 0.02
    assert moving.snapshot().velocities[0, 3] == pytest.approx(velocity)


def test_a_cloth_of_pins_keeps_its_shape(simulate, within, any_mode, layout):
    """Pins that go side by side drift apart."""
    simulation = simulate({**VALUES, 'mode': any_mode, 'layout': layout, 'pins': ['all']})
    start = simulation.snapshot().positions.astype(float)
    for node in np.ndindex(start.shape[:2]):
        simulation.move_pin(*node, start[node] + (0.7, 0.2, -0.4), 2.0)
    for _ in range(10):
        simulation.step(10)
        within('strain of a cloth of pins', simulation.snapshot().max_strain, 2e-5)
    np.testing.assert_allclose(
        simulation.snapshot().positions[3, 4] - start[3, 4],
        np.array((0.7, 0.2, -0.4)) * 0.3 * 2.0 / np.sqrt(0.69), atol=1e-6)
    simulation.step(100)
    np.testing.assert_array_equal(
        simulation.snapshot().positions, (start + (0.7, 0.2, -0.4)).astype(np.float32))


def test_damping_takes_a_node_along(simulate, within, mode, layout):
    """The damper between a pin and a node sees another velocity than the pin's."""
    mass, damping, dt, speed = 0.1, 2.0, 0.001, 0.6
    simulation = simulate({
        'mode': mode, 'layout': layout, 'rows': 2, 'cols': 1, 'height': 1.0,
        'pins': ['top_left'], 'node_mass': mass, 'start.z': 0.0, 'gravity': [0.0, 0.0, 0.0],
        'stiffness.structural': 0.0, 'damping.structural': damping, 'dt': dt,
        'auto_substeps': False})
    y = float(simulation.snapshot().positions[0, 0, 1])
    simulation.move_pin(0, 0, (0.0, y + 1.0, 0.0), speed)
    velocities = []
    for _ in range(200):
        simulation.step()
        velocities.append(simulation.snapshot().velocities[1, 0, 1])
    exact = speed * (1.0 - (1.0 - dt * damping / mass) ** np.arange(1, 201))
    within('a node behind a damper, over the speed of the pin',
           np.abs(np.array(velocities) - exact).max() / speed, 1e-5)


def test_moves_and_a_release_agree_with_the_oracle(simulate, within, mode, layout):
    """A pin goes another way than told, pulls otherwise, or is let go with another velocity."""
    simulation = simulate({**VALUES, 'mode': mode, 'layout': layout})
    oracle = MassSpringReference(simulation.scene)
    origin = oracle.positions[0, 0].copy()
    # Away from the cloth: one that buckles makes rounding grow.
    first, second = origin + (-0.04, 0.03, 0.02), origin + (-0.05, 0.03, 0.1)
    simulation.move_pin(0, 0, first, 0.9)
    simulation.step(25)
    drive(oracle, (0, 0), origin, first, 0.9, 25)
    simulation.move_pin(0, 0, second, 1.3)
    simulation.step(15)
    drive(oracle, (0, 0), first, second, 1.3, 15)
    snapshot = simulation.snapshot()
    assert snapshot.kinetic_energy == pytest.approx(oracle.energies().kinetic, rel=1e-4)
    assert snapshot.velocities[0, 0] == pytest.approx(
        oracle.velocities[0, 0], rel=1e-5, abs=1e-5)
    simulation.release(0, 0)
    oracle.free[0, 0] = True
    simulation.step(10)
    oracle.step(10)
    snapshot = simulation.snapshot()
    within('moving pins, against the oracle [m]',
           np.abs(snapshot.positions - oracle.positions).max(), 1e-5)
    within('moving pins, against the oracle [m/s]',
           np.abs(snapshot.velocities - oracle.velocities).max(), 2e-3)


@pytest.mark.parametrize('hard', [['structural', 'shear'], []], ids=['hard', 'springs'])
def test_constraints_agree_with_the_oracle(simulate, within, hard):
    """The solver does not see the velocity of a pin, or moves it."""
    springs = [] if hard else ['structural', 'shear', 'bend']
    simulation = simulate({
        **EXACT, 'mode': 'constraint', 'rows': 7, 'cols': 9, 'width': 1.3, 'dt': 0.005,
        # Beyond 1 % off the device takes lengths as they come, and holds them bit by bit.
        'start.jitter': 0.1 if springs else 0.004, 'pins': ['top_left', '3,8'],
        'auto_substeps': False,
        'stiffness.bend': 10.0 * bool(springs), 'damping.bend': 0.01 * bool(springs),
        'constraint.hard': hard, 'constraint.springs': springs})
    oracle = ImplicitCloth(simulation.scene)
    origin = oracle.positions[0, 0].copy()
    target = origin + (0.02, -0.01, 0.03)
    simulation.move_pin(0, 0, target, 0.8)
    simulation.step(8)
    drive(oracle, (0, 0), origin, target, 0.8, 8)
    snapshot = simulation.snapshot()
    speed = np.abs(oracle.velocities).max()
    within('constraints at moving pins, against the oracle [m]',
           np.abs(snapshot.positions - oracle.positions).max(), 2e-5)
    within('their velocities over the largest, but for the pin at rest',
           np.abs(snapshot.velocities - oracle.velocities)[1:].max() / speed, 2e-3)
    assert snapshot.solver_reached


def test_the_same_moves_give_the_same_bits(simulate, any_mode, layout):
    """A run depends on how it is cut into pieces, or on the run before a reset."""
    values = {
        **VALUES, 'mode': any_mode, 'layout': layout, 'pin_moves.start': [0.02, 0.031, 0.1],
        'pin_moves.node': ['top_left', '0,13', 'top_left'],
        'pin_moves.target': [-0.4, 0.6, 1.1, 0.6, 0.5, 0.8, -0.5, 0.5, 1.0],
        'pin_moves.speed': [1.0, 2.0, 0.7]}
    whole = simulate(values)
    for _ in range(2):
        whole.advance(0.3)
        first = whole.snapshot().state_sha256
        whole.move_pin(0, 0, (0.0, 0.0, 0.0))
        whole.advance(0.02)
        whole.reset()
    pieces = simulate(values)
    for _ in range(60):
        pieces.advance(0.005)
        pieces.snapshot()
    assert pieces.snapshot().state_sha256 == first
    assert pieces.time == pytest.approx(0.3)


def test_a_sudden_move_keeps_the_limit(simulate, within):
    """A mode that expects a resting cloth to stay at rest would miss the start of a pin."""
    simulation = simulate({
        'mode': 'adaptive', 'adaptive.threshold': 0.05, 'rows': 12, 'cols': 12,
        'gravity': [0.0, 0.0, 0.0], 'pins': ['top_edge'], 'dt': 0.01})
    simulation.advance(2.0)
    assert simulation.snapshot().max_strain < 1e-5
    for col, (x, y, z) in enumerate(simulation.snapshot().positions[0].tolist()):
        simulation.move_pin(0, col, (x, y + 0.4, z), 3.0)
    strains = []
    for _ in range(30):
        simulation.step()
        strains.append(simulation.snapshot().max_strain)
    assert max(strains) > 0.045
    within('strain behind pins that set off at 3 m/s', max(strains), 0.0625)


@pytest.mark.parametrize(('side', 'seconds'), [
    (8, 0.5), pytest.param(10, 1.0, marks=pytest.mark.long)])
def test_a_shaken_towel_does_not_stretch(simulate, within, side, seconds):
    """Moving pins tear the edges next to them beyond the limit."""
    simulation = simulate({**TOWEL, 'rows': side, 'cols': side, 'areal_density': 0.05})
    strains = shake(simulation, seconds)
    strains = strains[len(strains) // 2:]
    within('strain of a shaken towel', strains.max(), 0.02)
    within('its median', np.median(strains), 0.012)


@pytest.mark.long
@pytest.mark.parametrize('areal_density', [0.05, 0.2])
def test_a_fine_towel_shaken_for_a_minute_does_not_stretch(simulate, within, areal_density):
    """A light, fine cloth stretches like rubber when its pins are shaken, or blows up."""
    simulation = simulate({**TOWEL, 'rows': 64, 'cols': 64, 'areal_density': areal_density})
    strains = shake(simulation, 60.0)[100:]
    within('strain of a fine towel, shaken', strains.max(), 0.02)
    within('its median', np.median(strains), 0.012)
