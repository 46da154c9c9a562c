# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Snapshots made by hand: what is made from them is tested without a GL device."""

from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np


def make_snapshot(rows, cols, **changes):
    """Return a snapshot with random records and no flags; ``changes`` replace its fields."""
    random = np.random.default_rng(rows * 10007 + cols)
    records = np.zeros((rows, cols), POINT_DTYPE)
    for name in POINT_DTYPE.names[:-1]:
        records[name] = random.uniform(-1.0, 1.0, (rows, cols))
    records['strain'] = random.uniform(0.0, 0.1, (rows, cols))
    content = {
        'records': records, 'mode': 'mass_spring', 'time': 1.25, 'steps': 250, 'dt': 0.005,
        'substeps': 3, 'stability_margin': 0.5, 'kinetic_energy': 1.5, 'elastic_energy': 2.5,
        'gravitational_energy': -0.5, 'max_strain': 0.07, 'finite': True}
    return Snapshot(**{**content, **changes})
