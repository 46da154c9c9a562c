# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Serialised clouds made by hand, to record."""

from cloth_sim_ros.messages.points import PointsMessage
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
