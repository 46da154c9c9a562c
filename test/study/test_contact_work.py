# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Work and energy of contacts, held against plain formulas."""

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.colliders import Collider
from cloth_sim_ros.sim.contacts import ContactForce
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.contact_work import compression_energy
from cloth_sim_ros.study.contact_work import contact_work
from cloth_sim_ros.study.energy_account import EnergyAccount
import numpy as np
import pytest
from springs import SPRINGS

UPRIGHT = (0.0, 0.0, 0.0, 1.0)
QUARTER_TURN = (0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5))


def ball(position, orientation=UPRIGHT):
    """Return a sphere."""
    return Collider('ball', 'sphere', (0.1,), position, orientation, 0.0)


def test_work_is_force_times_way_and_torque_times_angle():
    """A body that moves would be taken for a source of energy, or the reverse."""
    force = ContactForce('ball', np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.0, 4.0]), 0, 0)
    before, after = ball((0.0, 0.0, 0.0)), ball((0.1, 0.0, -0.2), QUARTER_TURN)
    # What the cloth does to the body, the body does to the cloth with the other sign.
    expected = -(1.0 * 0.1 - 3.0 * 0.2 + 4.0 * np.pi / 2.0)
    assert contact_work([force], [before], [after]) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize('lacking, share', [(0.0005, 0.125), (0.002, 1.5)])
def test_compression_energy_is_that_of_its_pressure(lacking, share):
    """A gripper that opens would be taken for a source of energy."""
    thickness, pressure = 0.001, 2e5
    scene = Scene({
        **SPRINGS,
        'rows': 3, 'cols': 4, 'width': 0.4, 'height': 0.3, 'contact.thickness': thickness,
        'contact.compression': pressure})
    # A plane below, one above that faces down, and nodes in the middle.
    room = thickness - lacking
    planes = [
        Collider('below', 'plane', (), (0.0, 0.0, 0.0), UPRIGHT, 0.5),
        Collider('above', 'plane', (), (0.0, 0.0, room), (1.0, 0.0, 0.0, 0.0), 0.5)]
    positions = np.zeros((3, 4, 3))
    positions[..., 2] = 0.5 * room
    # Half of it up to a whole thickness, all of it beyond.
    expected = pressure * 0.4 * 0.3 * thickness * share
    assert compression_energy(scene, planes, positions) == pytest.approx(expected, rel=1e-9)
    assert compression_energy(scene, planes[:1], positions) == 0.0


@pytest.mark.parametrize('mode', ['mass_spring', 'constraint', 'adaptive'])
def test_a_cloth_that_is_lifted_by_a_body_gains_nothing(mode):
    """A table that rises with a cloth would be taken for a blow-up."""
    scene = Scene({
        **SPRINGS,
        'mode': mode, 'rows': 8, 'cols': 8, 'dt': 0.005, 'pins': ['none'], 'start.z': 0.002,
        'start.jitter': 0.0, 'colliders.names': ['table'], 'colliders.table.shape': 'box',
        'colliders.table.size': [3.0, 3.0, 0.2], 'colliders.table.position': [0.0, 0.0, -0.1],
        'collider_moves.name': ['table'], 'collider_moves.start': [0.1],
        'collider_moves.target': [0.2, 0.0, 0.4], 'collider_moves.speed': [1.0]})
    context = Context(single_thread=True)
    with Simulation(scene, context=context) as run:
        account = EnergyAccount(run)
        account.step(160)
        rise = account.seen.gravitational_energy - account.begin.gravitational_energy
        weight = scene.node_mass * scene.node_count * 9.81
        assert rise > 0.4 * weight
        assert account.gained < 0.02
    context.close()
