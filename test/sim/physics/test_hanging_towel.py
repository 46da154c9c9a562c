# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A towel hangs in still air: it comes to rest, and its pins carry its weight."""

from pathlib import Path

from cloth_sim_ros.sim.model.given_values import load_parameters
import numpy as np
import pytest

TOWEL = load_parameters(Path(__file__).parents[3] / 'config' / 'towel_at_rest.yaml')
SIZE = np.array([TOWEL['rows'], TOWEL['cols']])
STEPS = {'mass_spring': 0.005, 'constraint': 0.01, 'adaptive': 0.01}
PINS = [['top_edge'], ['top_left', 'top_right']]
# Modes with the share of the nodes along each side. Half of them take mode adaptive minutes.
FORMS = [
    *((mode, 0.5, pins) for mode in ('mass_spring', 'constraint') for pins in PINS),
    ('adaptive', 0.25, PINS[0]),
    *(pytest.param('adaptive', 0.5, pins, marks=pytest.mark.long) for pins in PINS)]


@pytest.fixture
def towel(simulate):
    """Return a function to a towel of a share of the nodes along each side."""

    def start(mode, share, **values):
        rows, cols = (int(nodes * share) for nodes in SIZE)
        return simulate({
            **TOWEL, 'mode': mode, 'dt': STEPS[mode], 'rows': rows, 'cols': cols,
            'adaptive.threshold': 0.01, **values})

    return start


def _check_rest(simulation, within, speed):
    snapshot = simulation.snapshot(pin_forces=True)
    weight = TOWEL['areal_density'] * TOWEL['width'] * TOWEL['height'] * 9.81
    within('largest speed [m/s]', np.linalg.norm(snapshot.velocities, axis=-1).max(), speed)
    within('forces at the pins over the weight, less 1',
           abs(snapshot.pin_forces.forces.sum(axis=0)[2] / weight + 1.0), 1e-3)


@pytest.mark.parametrize(('mode', 'share', 'pins'), FORMS)
def test_it_soon_hangs_still(towel, within, mode, share, pins):
    """Ripples would not decay, or grow."""
    simulation = towel(mode, share, pins=pins)
    simulation.advance(4.0)
    _check_rest(simulation, within, 0.02)


def test_ripples_of_a_fine_grid_fade(towel, within):
    """Steps far longer than ripples would feed them, while the solver reports success."""
    simulation = towel('constraint', 1.0, pins=['top_edge'])
    simulation.advance(0.3)
    before = simulation.snapshot()
    simulation.advance(0.7)
    after = simulation.snapshot()
    energies = [
        each.kinetic_energy + each.elastic_energy + each.gravitational_energy
        for each in (before, after)]
    within('energy gained [J]', energies[1] - energies[0], 1e-6)
    assert after.solver_reached
    _check_rest(simulation, within, 0.01)


@pytest.mark.long
def test_it_hangs_alike_at_half_the_nodes(towel, within, any_mode):
    """The shape would be that of the grid, or the towel never settle."""
    found = {}
    for share in (0.5, 1.0):
        simulation = towel(any_mode, share)
        simulation.advance(20.0)
        _check_rest(simulation, within, 0.005)
        found[share] = simulation.positions().astype(float)
    # Each fold can go to one side as to the other, and which it is comes from how it swung.
    places = _places(found[0.5], SIZE)
    fine = np.where(
        simulation.pinned_nodes()[..., np.newaxis], found[1.0], _at(found[0.5], *places))
    simulation.set_state(fine, np.zeros_like(fine))
    simulation.advance(10.0)
    _check_rest(simulation, within, 0.005)
    again = _at(simulation.positions().astype(float), *_places(fine, found[0.5].shape[:2]))
    within('difference in shape over the height',
           np.abs(again - found[0.5]).max() / TOWEL['height'], 0.02)


def _places(positions, size):
    """Return the rows and columns of ``positions`` that a grid of ``size`` has its nodes at."""
    return [np.linspace(0.0, nodes - 1.0, count) for nodes, count in zip(positions.shape, size)]


def _at(positions, rows, cols):
    """Return positions between the nodes, (rows, cols, 3), by linear interpolation."""
    own_rows, own_cols = (np.arange(count) for count in positions.shape[:2])
    across = np.stack([
        [np.interp(cols, own_cols, line[:, axis]) for line in positions]
        for axis in range(3)], axis=-1)
    return np.stack([
        [np.interp(rows, own_rows, line) for line in across[..., axis].T]
        for axis in range(3)], axis=-1).transpose(1, 0, 2)
