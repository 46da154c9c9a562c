# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Two bodies thinner than cells press on the cloth by its area, whatever its cells are."""

from math import cos
from math import sin

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest

SIDE = 0.36
THICKNESS, ROOM, COMPRESSION = 0.003, 0.0015, 1e4
RADIUS = 0.004
FINGER = {'shape': 'capsule', 'size': (RADIUS, 0.08)}


def along(angle):
    """Return the orientation of a body whose axis z is level, by its angle from x [rad]."""
    return tuple(0.5**0.5 * each for each in (
        -sin(0.5 * angle), cos(0.5 * angle), sin(0.5 * angle), cos(0.5 * angle)))


def around_z(angle):
    """Return the orientation of a body that is turned about z by an angle [rad]."""
    return (0.0, 0.0, sin(0.5 * angle), cos(0.5 * angle))


# Above and below: a body, and half its height. The cloth stays flat between them.
PAIRS = {
    'parallel fingers': lambda angle: 2 * ((
        {**FINGER, 'orientation': along(angle)}, RADIUS),),
    'spheres': lambda angle: 2 * (({'shape': 'sphere', 'size': (RADIUS,)}, RADIUS),),
    'bars': lambda angle: 2 * ((
        {'shape': 'box', 'size': (0.08, 0.008, 0.008), 'orientation': around_z(angle)}, 0.004),),
    'finger on a table': lambda angle: (
        ({**FINGER, 'orientation': along(angle)}, RADIUS),
        ({'shape': 'box', 'size': (2.0, 2.0, 0.1)}, 0.05))}


def pinched(pair, cells, place, angle, mode='mass_spring'):
    """Return the scene of a level cloth without weight, pinched by a pair."""
    values = {
        'mode': mode, 'material.preset': 'trousers', 'width': SIDE, 'height': SIDE,
        'rows': cells + 1, 'cols': cells + 1, 'dt': 0.005, 'air.density': 0.0,
        'pins': ('none',), 'gravity': (0.0, 0.0, 0.0), 'start.pose': 'horizontal',
        'start.z': 0.0, 'contact.thickness': THICKNESS, 'contact.compression': COMPRESSION,
        'colliders.names': ('above', 'below')}
    # It is in the middle of two thin bodies, and rests on a table.
    middle = 0.5 * (ROOM - THICKNESS) if pair == 'finger on a table' else 0.0
    for name, side, (body, half) in zip(('above', 'below'), (1.0, -1.0), PAIRS[pair](angle)):
        given = {
            **body, 'friction': 0.5, 'position': (*place, middle + side * (0.5 * ROOM + half))}
        values |= {f'colliders.{name}.{key}': value for key, value in given.items()}
    return Scene(values)


def pressure(bodies, place, samples=800, half=0.06):
    """Return the integral of the pressure over the plane of the cloth about a place [N]."""
    line = (np.arange(samples) + 0.5) * 2.0 * half / samples - half
    x, y = np.meshgrid(place[0] + line, place[1] + line, indexing='ij')
    points = np.stack([x, y, np.zeros_like(x)], axis=-1)
    lacking = THICKNESS - sum(body.distance(points) for body in bodies)
    return COMPRESSION * float(np.sum(np.clip(lacking / THICKNESS, 0.0, 1.0))) * (
        2.0 * half / samples)**2


SHORT = {('parallel fingers', 6), ('spheres', 12), ('finger on a table', 6)}


@pytest.mark.parametrize(('pair', 'cells'), [
    pytest.param(pair, cells, marks=[] if (pair, cells) in SHORT else [pytest.mark.long])
    for pair in PAIRS for cells in (6, 12, 24)])
def test_force_of_a_pinch_on_any_cells(context, within, pair, cells):
    """A force sensor in a finger would show the size of a cell."""
    cell = SIDE / cells
    random = np.random.default_rng([cells, len(pair)])
    worst, are_held = 0.0, True
    places = [((0.0, 0.0), 0.0), ((0.5, 0.35), 0.0), ((0.0, 0.5), 0.4),
              (random.random(2), random.random())]
    for place, angle in places:
        place = tuple(float(each) * cell for each in place)
        scene = pinched(pair, cells, place, float(angle))
        expected = pressure(scene.colliders, place)
        with Simulation(scene, context=context) as simulation:
            # It starts inside both bodies, which the first snapshot reports.
            simulation.step(8)
            simulation.snapshot()
            simulation.step(2)
            above, below = (body.force[2] for body in simulation.contact_forces())
            is_held = simulation.snapshot().surface_contact_held
        print(f'{place}, {angle:.2f} rad: {above / expected:.4f}, {-below / expected:.4f}, '
              f'held {is_held}')
        are_held = are_held and is_held
        worst = max(worst, abs(above / expected - 1.0), abs(-below / expected - 1.0))
    within('force over the integral of the pressure, less 1', worst, 0.1)
    assert are_held
