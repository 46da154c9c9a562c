# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Two pads that leave less room than a cloth is thick hold it by friction, up to its limit."""

import math

import numpy as np
import pytest

GRAVITY = 9.81
SHAKEN = 2.0  # [Hz]
AMPLITUDE = 0.01  # [m]
FRICTION, THICKNESS, GAP = 0.5, 0.002, 0.001
PADS = {'left': -1.0, 'right': 1.0}
# Between the pads are the first two of its rows.
TOWEL = {
    'rows': 9, 'cols': 5, 'width': 0.08, 'height': 0.16, 'pins': ['none'],
    'start.pose': 'hanging', 'start.z': 0.5, 'areal_density': 0.3, 'dt': 0.002,
    'contact.thickness': THICKNESS}
TOP, HELD_NODES = 0.58, 10
NODE_AREA = TOWEL['width'] * TOWEL['height'] / (TOWEL['rows'] * TOWEL['cols'])


def pad(side, height):
    """Return the centre of the pad on a side, that much higher than at the start."""
    return 0.0, side * (0.5 * GAP + 0.025), TOP - 0.01 + height


def pinched(mode, normal_force):
    """Return the scene of a towel between two pads that press on each node so hard [N]."""
    values = {
        **TOWEL, 'mode': mode, 'colliders.names': list(PADS),
        'contact.compression': normal_force / NODE_AREA / (1.0 - GAP / THICKNESS)}
    for name, side in PADS.items():
        values |= {
            f'colliders.{name}.shape': 'box', f'colliders.{name}.size': [0.2, 0.05, 0.03],
            f'colliders.{name}.position': list(pad(side, 0.0)),
            f'colliders.{name}.friction': FRICTION}
    return values


def shake(simulation, seconds):
    """Move both pads up and down, a little at first; return the largest slip in them [m]."""
    begin = simulation.positions()[:2, :, 2]
    omega, started = 2.0 * math.pi * SHAKEN, simulation.time
    slip, height = 0.0, 0.0
    while simulation.time < started + seconds and slip < 0.01:
        time = simulation.time + simulation.dt - started
        before = height
        height = AMPLITUDE * math.sin(omega * time) * min(2.0 * time, 1.0)
        for name, side in PADS.items():
            simulation.move_collider(
                name, pad(side, height), speed=max(abs(height - before) / simulation.dt, 1e-5))
        simulation.step()
        slip = max(slip, np.abs(simulation.positions()[:2, :, 2] - height - begin).max())
    return slip


@pytest.mark.parametrize('seconds', [1.0, pytest.param(60.0, marks=pytest.mark.long)])
@pytest.mark.parametrize(('load', 'is_held'), [(0.8, True), (1.25, False)])
def test_a_shaken_towel_is_held_up_to_the_limit(
        simulate, within, any_mode, load, is_held, seconds):
    """A gripper would lose a towel that it holds, or hold one whatever it weighs."""
    mass = TOWEL['areal_density'] * TOWEL['width'] * TOWEL['height']
    heaviest = mass * (GRAVITY + AMPLITUDE * (2.0 * math.pi * SHAKEN)**2)
    simulation = simulate(pinched(
        any_mode, heaviest / load / (2.0 * FRICTION * HELD_NODES)))
    assert simulation.scene.node_mass * simulation.scene.node_count == pytest.approx(mass)
    simulation.advance(0.1)
    slip = shake(simulation, seconds)
    if is_held:
        within('slip between the pads [m]', slip, 1e-5)
    else:
        assert slip > 0.01


def test_pads_feel_the_cloth_that_they_compress(simulate, within, any_mode):
    """A force sensor in a finger would show nothing, or another force than friction goes by."""
    simulation = simulate(pinched(any_mode, 0.02))
    simulation.advance(1.5)
    left, right = simulation.contact_forces()
    within('force on the left pad over that of the law, less 1',
           abs(left.force[1] / (-0.02 * HELD_NODES) - 1.0), 1e-3)
    within('sum of the normal forces over one of them',
           abs(left.force[1] + right.force[1]) / 0.2, 1e-3)
    weight = simulation.scene.node_mass * simulation.scene.node_count * GRAVITY
    within('both carry the weight, less 1',
           abs((left.force[2] + right.force[2]) / -weight - 1.0), 1e-2)


def test_nothing_is_thrown_by_pads_that_close(simulate, within, any_mode):
    """Fingers that close to nothing would shoot the cloth away."""
    values = pinched(any_mode, 0.01)
    for name, side in PADS.items():
        values[f'colliders.{name}.position'] = [0.0, side * 0.035, TOP - 0.01]
    simulation = simulate({**values, 'gravity': [0.0, 0.0, 0.0]})
    for name, side in PADS.items():
        simulation.move_collider(name, (0.0, side * 0.025, TOP - 0.01), speed=0.1)
    simulation.advance(0.3)
    within('speed of the cloth in the end [m/s]', np.abs(simulation.velocities()).max(), 1e-3)
    within('way off the middle plane [m]', np.abs(simulation.positions()[..., 1]).max(), 1e-4)
