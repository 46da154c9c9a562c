# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Cloths and scenes for cameras to look at."""

from typing import Any

from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from cloth_sim_ros.sim.snapshot import Snapshot
from made_snapshot import make_snapshot
import numpy as np

ASIDE = {'position': [1.5, 0.3, 1.2], 'target': [0.0, 0.0, 0.2], 'width': 160, 'height': 120}
FALLING = {
    'rows': 12, 'cols': 10, 'width': 0.8, 'height': 0.9, 'pins': ['none'], 'start.z': 0.6,
    'colliders.names': ['ball', 'ground'], 'colliders.ball.size': [0.2],
    'colliders.ball.position': [0.0, 0.0, 0.25], 'colliders.ground.shape': 'plane'}


def snapshot_of(positions: np.ndarray, flags: np.ndarray | int = 0) -> Snapshot:
    """Return a snapshot of a cloth at ``positions``, (rows, cols, 3) [m]."""
    rows, cols = positions.shape[:2]
    records = np.zeros((rows, cols), POINT_DTYPE)
    for axis, name in enumerate('xyz'):
        records[name] = positions[..., axis]
    records['flags'] = flags
    return make_snapshot(rows, cols, records=records)


def plane_cloth(origin: Any, right: Any, down: Any, rows: int = 5, cols: int = 7) -> np.ndarray:
    """Return the positions of a flat cloth, (rows, cols, 3) [m]."""
    across = np.linspace(0.0, 1.0, cols)[None, :, None]
    along = np.linspace(0.0, 1.0, rows)[:, None, None]
    return np.asarray(origin) + across * np.asarray(right) + along * np.asarray(down)
