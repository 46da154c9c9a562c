# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The momenta of a cloth as a snapshot has it."""

from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np


def momenta(snapshot: Snapshot) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Return sums over nodes of v, of x cross v, of |v| and of |x| |v|."""
    positions = snapshot.positions.astype(float)
    velocities = snapshot.velocities.astype(float)
    speed = np.linalg.norm(velocities, axis=-1)
    return (velocities.sum(axis=(0, 1)), np.cross(positions, velocities).sum(axis=(0, 1)),
            speed.sum(), (np.linalg.norm(positions, axis=-1) * speed).sum())
