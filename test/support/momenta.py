# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The momenta of a cloth as a snapshot has it."""

from cloth_sim_ros.sim.held.pin_forces import filled
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np


def momenta(snapshot: Snapshot) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Return sums over nodes of v, of x cross v, of |v| and of |x| |v|."""
    positions = snapshot.positions.astype(float)
    velocities = snapshot.velocities.astype(float)
    speed = np.linalg.norm(velocities, axis=-1)
    return (velocities.sum(axis=(0, 1)), np.cross(positions, velocities).sum(axis=(0, 1)),
            speed.sum(), (np.linalg.norm(positions, axis=-1) * speed).sum())


def momenta_of(simulation: Simulation) -> tuple[np.ndarray, np.ndarray]:
    """Return momentum [N s] and angular momentum [N m s] of a cloth of unequal masses."""
    scene = simulation.scene
    positions, velocities = (
        filled(scene, each).astype(float)
        for each in (simulation.positions(), simulation.velocities()))
    momentum = scene.node_mass * scene.node_shares[..., None] * velocities
    return momentum.sum(axis=(0, 1)), np.cross(positions, momentum).sum(axis=(0, 1))
