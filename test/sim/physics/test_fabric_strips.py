# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Strips of a measured fabric against the heavy elastica and the beam, on any grid.

A scene says what a user measures: size, mass per area, rigidity. A strip is clamped by its first
two lines of nodes, so half way between them, and ends at its last nodes.
"""

from functools import lru_cache

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest
from scipy.integrate import solve_bvp

LENGTH = 0.1    # [m] free
DENSITY = 0.1   # [kg/m2]
WEIGHT = DENSITY * 9.81
# Chord angle [degrees] and drop of the tip over the length, by w L^3 / B.
ELASTICA = {
    1: (7.10, 0.1235), 4: (25.53, 0.4252), 8: (41.49, 0.6406), 16: (57.39, 0.7970),
    32: (69.50, 0.8785), 64: (77.19, 0.9201)}
# Damping time of bending in explicit modes [s]: above it, substeps become shorter.
DAMPING = 1e-5
# beta L of the first mode of a beam that is clamped at one end [1].
MODE = 1.8751041


@lru_cache
def drop_of_elastica(load):
    """Return the drop of the tip over the length of an inextensible strip, load w L^3 / B."""
    s = np.linspace(0.0, 1.0, 400)
    found = solve_bvp(
        lambda s, y: np.vstack((y[1], -load * (1.0 - s) * np.cos(y[0]))),
        lambda begin, end: np.array([begin[0], end[1]]), s, np.zeros((2, s.size)), tol=1e-9,
        max_nodes=100_000)
    places = np.linspace(0.0, 1.0, 20_001)
    sines = np.sin(found.sol(places)[0])
    return float(np.sum(0.5 * (sines[1:] + sines[:-1]) * np.diff(places)))


@pytest.fixture
def strip(context, any_mode):
    """Return a function to a simulation of a clamped strip of fabric."""
    opened = []

    def start(nodes, lines, load, axis=1, **values):
        cell = LENGTH / (nodes - 1.5)
        rigidity = WEIGHT * LENGTH**3 / load
        slowest = MODE**2 / LENGTH**2 * np.sqrt(rigidity / DENSITY)
        damping = float(1.0 / slowest) if any_mode == 'constraint' else DAMPING
        size = {'cols': nodes, 'rows': lines, 'width': cell * (nodes - 1), 'height': 0.02}
        if axis == 0:
            size = {'rows': nodes, 'cols': lines, 'height': cell * (nodes - 1), 'width': 0.02}
        held = [f'{line},{place}' if axis == 1 else f'{place},{line}'
                for line in range(lines) for place in (0, 1)]
        simulation = Simulation(Scene({
            'mode': any_mode, **size, 'pins': held, 'areal_density': DENSITY,
            'bending.rigidity': rigidity, 'bending.damping': damping,
            'start.z': 0.0, 'air.density': 0.0, 'dt': 0.002, 'solver.tolerance': 1e-4,
            'adaptive.threshold': 0.1, **values}), context=context)
        opened.append(simulation)
        return simulation

    yield start
    for simulation in opened:
        simulation.close()


def come_to_rest(simulation):
    """Wait in an implicit mode; else stop all nodes whenever their energy has begun to fall."""
    if simulation.mode == 'constraint':
        simulation.advance(2.0)
        return
    largest = before = 0.0
    while True:
        simulation.step()
        now = simulation.measure().kinetic_energy
        if now < before:
            if before < 1e-6 * largest:
                return
            largest = max(largest, before)
            positions = simulation.positions()
            simulation.set_state(positions, np.zeros_like(positions))
            now = 0.0
        before = now


def tip_of(simulation, axis=1):
    """Return the place of the tip, from where the strip is clamped, along it and down [m]."""
    positions = simulation.positions().astype(float).mean(axis=1 - axis)
    along = 0 if axis == 1 else 1
    clamp = 0.5 * (positions[0] + positions[1])
    return abs(positions[-1, along] - clamp[along]), clamp[2] - positions[-1, 2]


@pytest.mark.parametrize(('lines', 'axis'), [
    (2, 1), (5, 1), (2, 0), pytest.param(3, 1, marks=pytest.mark.long),
    pytest.param(9, 1, marks=pytest.mark.long), pytest.param(5, 0, marks=pytest.mark.long)])
def test_a_strip_sags_alike_on_any_lines(strip, within, lines, axis):
    """By 0.51 of the beam's with 2 lines and 0.91 with 9, when a node stood for a cell."""
    simulation = strip(17, lines, 0.5, axis)
    come_to_rest(simulation)
    _, drop = tip_of(simulation, axis)
    within(f'{lines} lines, axis {axis}, drop of the tip, relative',
           abs(drop / LENGTH / drop_of_elastica(0.5) - 1.0), 0.01)


@pytest.mark.parametrize('load', [
    pytest.param(load, marks=[] if load in (8, 64) else pytest.mark.long) for load in ELASTICA])
def test_chord_angle_of_the_heavy_elastica(strip, within, load):
    """Strips that hang far down, by the table."""
    simulation = strip(33, 2, load)
    come_to_rest(simulation)
    along, down = tip_of(simulation)
    angle, drop = ELASTICA[load]
    within(f'w L^3 / B = {load}, chord angle, relative',
           abs(np.degrees(np.arctan2(down, along)) / angle - 1.0), 0.01)
    within(f'w L^3 / B = {load}, drop of the tip, relative',
           abs(down / LENGTH / drop - 1.0), 0.01)


# An explicit mode comes to rest within 1e-3 here, which is what 33 columns are off by.
@pytest.mark.long
@pytest.mark.parametrize('any_mode', ['constraint'], indirect=True)
def test_sag_converges_at_second_order(strip, within):
    """A border that counts for whole cells made it the first order."""
    errors = []
    for nodes in (9, 17, 33):
        simulation = strip(nodes, 3, 4.0)
        come_to_rest(simulation)
        errors.append(abs(tip_of(simulation)[1] / LENGTH / drop_of_elastica(4.0) - 1.0))
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    within(f'order of {errors}, below 2', 2.0 - float(orders.min()), 0.2)


@pytest.mark.parametrize('lines', [2, pytest.param(17, marks=pytest.mark.long)])
def test_frequency_of_a_strip_of_fabric(strip, within, lines):
    """The mass of the tip is that of half a cell."""
    simulation = strip(
        33, lines, 0.5, gravity=[0.0, 0.0, 0.0], dt=5e-4, **{'bending.damping': 0.0})
    positions = simulation.positions().astype(float)
    at = MODE / LENGTH * np.maximum(positions[0, :, 0] - positions[0, :2, 0].mean(), 0.0)
    shape = np.cosh(at) - np.cos(at) - 0.7340955 * (np.sinh(at) - np.sin(at))
    shape[:2] = 0.0
    positions[..., 2] += 0.005 * LENGTH * shape
    simulation.set_state(positions, np.zeros_like(positions))
    rigidity = WEIGHT * LENGTH**3 / 0.5
    quarter = 0.5 * np.pi / ((MODE / LENGTH)**2 * np.sqrt(rigidity / DENSITY))
    drops = [tip_of(simulation)[1]]
    while drops[-1] < 0.0:
        simulation.step()
        drops.append(tip_of(simulation)[1])
    crossed = simulation.time - simulation.dt * drops[-1] / (drops[-1] - drops[-2])
    within(f'{lines} lines, frequency of the first mode, relative',
           abs(quarter / crossed - 1.0), 0.01)


@pytest.mark.parametrize('lines', [2, 9])
@pytest.mark.parametrize('axis', [0, 1])
def test_a_hanging_strip_stretches_by_its_stiffness(context, any_mode, within, lines, axis):
    """By w L^2 / (2 E): lines at the border as stiff as others made a narrow strip stiffer."""
    if any_mode == 'constraint':
        edges = {'constraint.hard': [], 'constraint.springs': ['structural', 'shear']}
    else:
        edges = {'adaptive.threshold': 0.5}
    nodes, length, stiffness = 17, 0.5, 50.0
    size = {'rows': nodes, 'cols': lines, 'height': length, 'width': 0.04}
    pins = [f'0,{line}' for line in range(lines)]
    gravity = [0.0, 0.0, -9.81]
    if axis == 1:
        size = {'cols': nodes, 'rows': lines, 'width': length, 'height': 0.04}
        pins = [f'{line},0' for line in range(lines)]
        gravity = [9.81, 0.0, 0.0]
    with Simulation(Scene({
            'mode': any_mode, **size, 'pins': pins, 'areal_density': 0.2, 'gravity': gravity,
            'material.warp': stiffness, 'material.weft': stiffness, 'material.shear': 0.0,
            'damping.structural': 0.02, 'air.density': 0.0, 'bending.rigidity': 0.0,
            'start.pose': 'hanging', 'start.z': 0.0, 'dt': 0.005, **edges}),
            context=context) as simulation:
        come_to_rest(simulation)
        positions = simulation.positions().astype(float)
    ends = positions[[0, -1]] if axis == 0 else positions[:, [0, -1]].swapaxes(0, 1)
    stretched = float(np.linalg.norm(np.subtract(*ends.mean(axis=1)))) - length
    exact = 0.2 * 9.81 * length**2 / (2.0 * stiffness)
    within(f'{lines} lines, axis {axis}, stretch by weight, relative',
           abs(stretched / exact - 1.0), 0.005)
