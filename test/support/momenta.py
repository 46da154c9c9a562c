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
