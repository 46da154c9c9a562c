# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Equilibria of a drape, by Newton's method: those of a simulation, and of a beam."""

from pathlib import Path
import subprocess
import sys

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from drape_at_rest import Drape
from drape_at_rest import figures
from drape_at_rest import Lattice
from drape_at_rest import refined
from drape_at_rest import rest
import numpy as np

ROOT = Path(__file__).parents[2]
DRAPE = Drape(load=13.08, stiffness=1e6)
NODES = 9


def test_forces_are_the_slope_of_the_energy():
    """A force is not that of the energy, or the matrix not that of the forces."""
    lattice = Lattice(DRAPE, 5)
    random = np.random.default_rng(1)
    positions = DRAPE.start(5).reshape(-1, 3) + 0.02 * random.standard_normal((25, 3))
    move = 1e-6 * random.standard_normal((25, 3))
    change = lattice.energy(positions + move) - lattice.energy(positions - move)
    np.testing.assert_allclose(
        change, -2.0 * np.sum(lattice.forces(positions) * move), rtol=1e-6)
    slope = lattice.forces(positions + move) - lattice.forces(positions - move)
    stiff = lattice.matrix(positions, is_near=True) @ move.ravel()
    np.testing.assert_allclose(slope.ravel(), -2.0 * stiff, atol=1e-6 * np.abs(stiff).max())


def test_a_simulation_stays_at_its_equilibrium():
    """The lattice has other edges, masses or rigidities than a fabric of the product."""
    start = DRAPE.start(NODES)
    positions, forces = rest(DRAPE, start)
    with Simulation(Scene({
            'mode': 'constraint', 'constraint.hard': [],
            'constraint.springs': ['structural', 'shear'], 'rows': NODES, 'cols': NODES,
            'width': 1.0, 'height': 1.0, 'areal_density': 1.0 / 9.81, 'material.warp': 1e6 / 13.08,
            'material.weft': 1e6 / 13.08, 'material.shear': 1e6 / 39.24,
            'bending.rigidity': 1.0 / 13.08, 'start.pose': 'hanging', 'start.z': 0.0,
            'air.density': 0.0, 'solver.tolerance': 1e-4, 'dt': 0.01})) as simulation:
        simulation.set_state(positions, np.zeros_like(positions))
        simulation.advance(0.1)
        snapshot = simulation.snapshot(pin_forces=True)
    np.testing.assert_allclose(snapshot.positions, positions, atol=1e-5)
    np.testing.assert_allclose(
        snapshot.pin_forces.forces, forces[0, [0, -1]], atol=1e-4)


def test_figures_and_refinement():
    """What is read off is that of another node, or a finer start lies elsewhere."""
    coarse, fine = DRAPE.start(13), DRAPE.start(25)
    assert np.abs(refined(coarse, 25) - fine).max() < 1e-4
    forces = np.zeros_like(coarse)
    forces[0, 0, 0], forces[0, -1, 0] = -0.25, 0.25
    found = figures(coarse, forces, DRAPE.held(13))
    assert found['horizontal force'] == 0.25
    assert found['drop of the middle'] == 0.5
    assert found['drop of the lowest node'] == 1.0


def test_program_prints_orders():
    """It does not run from the command line."""
    done = subprocess.run(
        [sys.executable, ROOT / 'benchmarks' / 'drape_at_rest.py', '--nodes', '5', '9', '17'],
        capture_output=True, text=True, check=True)
    assert 'horizontal force: ' in done.stdout
    assert done.stdout.count('order ') == 5
