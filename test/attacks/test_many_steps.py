# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A small cloth for ten million steps."""

from fractions import Fraction

from cloth_sim_ros.messages.stamp import nanoseconds
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest
from springs import SPRINGS

DT = 0.001
BATCH = 50_000


@pytest.mark.parametrize('steps', [100_000, pytest.param(10_000_000, marks=pytest.mark.long)])
def test_time_and_conserved_quantities_stay(steps):
    """Time would drift from steps times dt, stamps stand still, or rounding add up to motion."""
    scene = Scene({
        **SPRINGS, 'rows': 2, 'cols': 3, 'width': 1.0, 'height': 0.5, 'dt': DT, 'pins': ['none'],
        'gravity': [0.0, 0.0, 0.0], 'damping.structural': 0.0, 'damping.shear': 0.0,
        'damping.bend': 0.0, 'start.jitter': 0.2, 'start.seed': 4})
    simulation = Simulation(scene)
    mass = scene.node_mass
    start = simulation.snapshot()
    energy = start.total_energy
    center = start.positions.astype(float).mean(axis=(0, 1))
    # Sum over all nodes [m/s]. Each step rounds each velocity by up to half its last digit, one
    # way or the other: a random walk, here with four times its standard deviation.
    speed = np.sqrt(2.0 * energy / (mass * scene.node_count))
    drift = 4.0 * 2.0**-24 * speed * np.sqrt(scene.node_count * steps)
    stamp = -1
    for done in range(BATCH, steps + 1, BATCH):
        simulation.step(BATCH)
        now = simulation.time
        assert simulation.steps == done
        assert abs(Fraction(now) - done * Fraction(str(DT))) < Fraction(1, 10**9)
        assert nanoseconds(now) > stamp
        stamp = nanoseconds(now)
        snapshot = simulation.snapshot()
        assert np.isfinite(snapshot.positions).all()
        momentum = mass * snapshot.velocities.astype(float).sum(axis=(0, 1))
        assert np.abs(momentum).max() <= mass * drift
        # The explicit step keeps it up to an oscillation of the order of dt times the frequency.
        assert snapshot.total_energy == pytest.approx(energy, rel=0.1)
    moved = np.abs(snapshot.positions.astype(float).mean(axis=(0, 1)) - center).max()
    print(
        f'{steps} steps: time {simulation.time} s, energy {snapshot.total_energy / energy:.6f} of '
        f'the start, momentum {np.abs(momentum).max():.3g} kg m/s of {mass * drift:.3g} that '
        f'rounding may give, moved by {moved:.3g} m')
    assert moved <= drift / scene.node_count * simulation.time + steps * 2.0**-24
    simulation.close()
