# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where cameras are that are attached to frames of tf."""

from collections.abc import Callable

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.messages.time_base import TimeBase
from cloth_sim_ros.node.followers import LATE
from cloth_sim_ros.node.input_frames import InputFrames
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.cameras import CameraModel
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.simulation import Simulation


class CameraPlaces:
    """
    Finds the frames of cameras; used on the device thread.

    :param frames: has the frames of tf
    :param base: of the stamps; where tf has the same, a camera is where its frame is at that time
    :param warn: is given a sentence that the user should know
    """

    def __init__(
            self, simulation: Simulation, frames: InputFrames, base: TimeBase,
            warn: Callable[[str], object]) -> None:
        """Begin with frames that have not come."""
        self._simulation = simulation
        self._frames = frames
        self._base = base
        self._warn = warn
        # Simulated time since which the frame of a camera is missing [s].
        self._missing: dict[str, float] = {}
        self._told: set[str] = set()

    @property
    def waiting(self) -> tuple[tuple[str, str], ...]:
        """Return names of cameras that somebody reads and whose frame is not known, and it."""
        return tuple(
            (camera.name, camera.frame) for camera in self._simulation.scene.cameras
            if camera.name in self._missing)

    def find(self, camera: CameraModel) -> Pose | None:
        """Return where the frame of ``camera`` is now; None, and a warning once, if unknown."""
        now = self._simulation.time
        try:
            place, _ = self._frames.place(camera.frame, self._base.at(now))
        except ClothSimError as error:
            self._note(camera, now, str(error))
            return None
        self._missing.pop(camera.name, None)
        self._told.discard(camera.name)
        return place

    def _note(self, camera: CameraModel, now: float, reason: str) -> None:
        # After a reset, time is earlier than it was.
        since = min(self._missing.setdefault(camera.name, now), now)
        if now - since > LATE and camera.name not in self._told:
            self._told.add(camera.name)
            self._warn(
                f'camera {camera.name} takes no pictures, as its frame {shown(camera.frame)} has '
                f'not come for {now - since:.3g} s: {reason}')
