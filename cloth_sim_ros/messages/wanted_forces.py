# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The forces of a frame, added up only while somebody reads them."""

from cloth_sim_ros.sim.force_window import ForceWindow
from cloth_sim_ros.sim.force_window import FrameForces
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot


class WantedForces:
    """
    Means over frames of the forces of the cloth on pins, grasps and colliders.

    The first frame in which they are wanted has those of the last step of dt, if they are known.
    """

    def __init__(self, simulation: Simulation) -> None:
        """Add up nothing yet."""
        self._simulation = simulation
        self._window: ForceWindow | None = None

    def of(self, snapshot: Snapshot) -> FrameForces | None:
        """
        Return those of the frame that ends with ``snapshot``, which is of this time.

        None where the last step was cut short before anybody wanted them.
        """
        if self._window is None:
            self._window = self._simulation.open_force_window()
        if not self._simulation.knows_forces:
            return None
        return self._simulation.frame_forces(self._window, snapshot)

    def leave_out(self) -> None:
        """Add up nothing until they are wanted again."""
        if self._window is not None:
            self._simulation.close_force_window(self._window)
            self._window = None
