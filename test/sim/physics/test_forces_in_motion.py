# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A cloth that moves: what it gives to pins, grasps and colliders is what its momentum loses."""

import numpy as np
import pytest

MODES = {
    'mass_spring': {'mode': 'mass_spring'},
    'paper layout': {'mode': 'mass_spring', 'layout': 'paper', 'loads': 'auto', 'block': 0},
    'constraint': {'mode': 'constraint'},
    'adaptive': {'mode': 'adaptive'},
    'adaptive at its limit': {'mode': 'adaptive', 'adaptive.threshold': 0.01},
    'adaptive paper': {'mode': 'adaptive', 'adaptive.threshold': 0.01, 'adaptive.scheme': 'paper'},
}
SUBSTEPS = (1, 4, pytest.param(7, marks=pytest.mark.long), 32)
BENT = {'bending.rigidity': 1e-3, 'bending.damping': 1e-3, 'stiffness.bend': 5.0}


@pytest.fixture(params=MODES.values(), ids=MODES)
def mode_values(request):
    """Return the values of each way to make steps."""
    return request.param


def taken(simulation):
    """Return the force of the cloth on everything that holds or touches it [N], (3,)."""
    held = simulation.grasped_nodes()
    pins = simulation.pin_forces()
    alone = ~held[tuple(pins.nodes.T)]
    return (
        pins.forces[alone].sum(axis=0)
        + sum((grasp.force for grasp in simulation.grasp_forces()), np.zeros(3))
        + sum((body.force for body in simulation.contact_forces()), np.zeros(3)))


def momentum(simulation):
    """Return the momentum of the cloth [kg m/s], (3,), with that of nodes that are held."""
    return simulation.scene.node_mass * simulation.velocities().astype(float).sum(axis=(0, 1))


def weight(simulation):
    """Return the weight of the cloth [N], (3,)."""
    scene = simulation.scene
    return scene.mass * np.array(scene['gravity'])


def check_momentum(simulation, within, steps):
    """Step, and compare the impulse of the cloth with its loss of momentum."""
    begun, given, exchanged = momentum(simulation), np.zeros(3), 0.0
    touched = set()
    for _ in range(steps):
        simulation.step()
        touched |= {body.name for body in simulation.contact_forces() if body.force.any()}
        force = taken(simulation)
        given += simulation.dt * force
        exchanged += simulation.dt * np.linalg.norm(force)
    seconds = steps * simulation.dt
    lost = begun - momentum(simulation) + seconds * weight(simulation)
    within('impulse given less momentum lost, over the impulse exchanged',
           np.abs(given - lost).max() / exchanged, 1e-4)
    assert touched == {body.name for body in simulation.colliders}


@pytest.mark.parametrize('substeps', SUBSTEPS)
def test_a_pulled_chain_has_the_impulse_of_its_pin(simulate, within, mode_values, substeps):
    """A controller would integrate 0.0068 N s for the 0.4 N s that a chain of 0.4 kg has got."""
    simulation = simulate({
        'rows': 1, 'cols': 4, 'node_mass': 0.1, 'gravity': [0.0, 0.0, 0.0], 'dt': 0.002,
        'pins': ['top_left'], 'auto_substeps': False, 'substeps': substeps, **mode_values})
    place = simulation.positions()[0, 0].astype(float)
    simulation.move_pin(0, 0, place - (1.0, 0.0, 0.0), 1.0)
    check_momentum(simulation, within, 50)


@pytest.mark.parametrize('substeps', SUBSTEPS)
def test_pins_that_move_and_stop(simulate, within, mode_values, substeps):
    """A robot would feel another force than the cloth gives it, as a pin moves, stops or jumps."""
    simulation = simulate({
        'rows': 9, 'cols': 7, 'pins': ['top_left', 'top_right', '4,3'], 'dt': 0.001,
        'auto_substeps': False, 'substeps': substeps, **BENT, **mode_values})
    simulation.advance(0.1)
    positions = simulation.positions().astype(float)
    for row, col in np.argwhere(simulation.pinned_nodes()).tolist():
        simulation.move_pin(row, col, positions[row, col] + (0.02, 0.0, 0.01), 0.5)
    check_momentum(simulation, within, 100)
    assert not simulation.pin_moves


@pytest.mark.parametrize('substeps', SUBSTEPS)
def test_pins_grasps_and_colliders_together(simulate, within, mode_values, substeps):
    """What one of them gives to the cloth would be missing at another."""
    touches = not {'layout', 'adaptive.scheme'} & mode_values.keys()
    bodies = {
        'colliders.names': ['floor', 'ball'], 'colliders.floor.shape': 'plane',
        'colliders.ball.shape': 'sphere', 'colliders.ball.size': [0.05],
        'colliders.ball.position': [0.0714, 0.0556, 0.0]} if touches else {}
    simulation = simulate({
        'rows': 10, 'cols': 8, 'pins': ['0,0'], 'dt': 0.001, 'auto_substeps': False,
        'substeps': substeps, 'start.z': 0.06, **bodies, **BENT, **mode_values})
    simulation.grasp('gripper', simulation.positions()[9, 7].astype(float), radius=0.12)
    grasp, = simulation.grasps
    simulation.move_grasp('gripper', np.array(grasp.pose.position) + (0.0, 0.0, 0.05), speed=0.5)
    check_momentum(simulation, within, 150)


@pytest.mark.parametrize('mode', ['mass_spring', 'constraint', 'adaptive'])
def test_a_falling_cloth_that_is_caught_by_a_pin(simulate, within, mode):
    """A node that is pinned in flight would lose its momentum to nobody."""
    simulation = simulate({'rows': 6, 'cols': 6, 'mode': mode, 'pins': [], 'dt': 0.005})
    simulation.advance(0.2)
    begun, fallen = momentum(simulation), simulation.time
    simulation.pin(0, 0)
    simulation.grasp('gripper', simulation.positions()[5, 5].astype(float))
    given = np.zeros(3)
    for _ in range(40):
        simulation.step()
        given += simulation.dt * taken(simulation)
    lost = begun - momentum(simulation) + (simulation.time - fallen) * weight(simulation)
    within('impulse given less momentum lost, over the momentum caught',
           np.abs(given - lost).max() / np.linalg.norm(begun), 1e-4)


@pytest.mark.parametrize('mode', ['mass_spring', 'constraint', 'adaptive'])
def test_power_of_a_stopped_sheet(simulate, within, mode):
    """A controller would measure half the power with which it stops a sheet from 3 m/s."""
    simulation = simulate({
        'rows': 8, 'cols': 8, 'mode': mode, 'dt': 0.01, 'gravity': [0.0, 0.0, 0.0],
        'pins': ['top_edge']})
    nodes = np.argwhere(simulation.pinned_nodes())
    work = expected = 0.0
    for step in range(60):
        speed = min(3.0, 0.2 * (step + 1)) if step < 40 else max(2.8 - 0.2 * (step - 40), 1e-6)
        positions = simulation.positions().astype(float)
        for row, col in nodes.tolist():
            simulation.move_pin(row, col, positions[row, col] - (9.0, 0.0, 0.0), speed)
        begun = momentum(simulation)
        simulation.step()
        if step >= 40:
            work += simulation.dt * speed * taken(simulation)[0]
            expected += speed * (momentum(simulation) - begun)[0]
    within('power that the pins take less that of the momentum, over it',
           abs(work / expected + 1.0), 1e-4)
    assert mode == 'constraint' or simulation.substeps > 1
