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

"""Add to a snapshot what the cloth feels."""

from dataclasses import replace

from cloth_sim_ros.sim.modes.mode import Mode
from cloth_sim_ros.sim.pin_forces import pin_forces
from cloth_sim_ros.sim.pin_motion import PinMotion
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np


def with_forces(
        snapshot: Snapshot, scene: Scene, mode: Mode, pins: PinMotion, *,
        every_edge: bool) -> Snapshot:
    """
    Return ``snapshot`` with the forces at its pins.

    :param mode: that made its last step
    :param pins: whose velocities were changed for that step
    :param every_edge: True to add the tension of every edge too, at a cost that grows with the
        cloth
    """
    positions, velocities = snapshot.positions, snapshot.velocities
    nodes = np.argwhere(snapshot.flags & FLAG_PINNED)
    # A state that is not finite has no finite forces either.
    with np.errstate(invalid='ignore', over='ignore'):
        tension = mode.tension(positions, velocities, None if every_edge else nodes)
        return replace(
            snapshot, tension=tension if every_edge else None,
            pin_forces=pin_forces(
                scene, positions, tension, nodes, pins.velocity_changes(nodes) / snapshot.dt))
