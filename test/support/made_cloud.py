# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Serialised clouds made by hand, to record."""

from cloth_sim_ros.messages.frame import PointsMessage
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from made_snapshot import make_snapshot
import numpy as np


def make_cloud(rows, cols, number):
    """Return frame ``number`` at 50 Hz, serialised, and its records: bits that don't compress."""
    random = np.random.default_rng(number)
    # Below 2^30 they are no infinite numbers and all are numbers.
    words = random.integers(0, 2**30, (rows, cols, POINT_DTYPE.itemsize // 4), dtype=np.uint32)
    records = words.view(POINT_DTYPE)[..., 0]
    snapshot = make_snapshot(rows, cols, records=records, time=number / 50)
    return PointsMessage(rows, cols, 'world').serialise(snapshot), records
