# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cameras of a running scene, each with its rate."""

from collections.abc import Callable
from collections.abc import Collection
import math

from cloth_sim_ros.camera.camera import Camera
from cloth_sim_ros.camera.camera import WORLD
from cloth_sim_ros.camera.picture import CameraPicture
from cloth_sim_ros.camera.picture_file import check_pictures
from cloth_sim_ros.sim.model.cameras import CameraModel
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.simulation import Simulation

# What can be taken of a picture, and what is drawn for it.
COLOR, DEPTH, LABELS, INFO = 'color', 'depth', 'labels', 'info'
# Rounding of a time over the time between two pictures [1].
_ROUNDING = 1e-6


class CameraRig:
    """
    Takes pictures of a simulation, on its thread.

    :param place: returns where a frame of tf is in the world; None where it is not known
    """

    def __init__(
            self, simulation: Simulation, place: Callable[[CameraModel], Pose | None]) -> None:
        """
        Make nothing on the device: a camera that nobody reads costs nothing.

        :raises ClothSimError: when a picture that the look of the scene names is not there
        """
        check_pictures(simulation.scene.look)
        self._simulation = simulation
        self._place = place
        self._cameras: dict[str, Camera] = {}
        # Time of the last picture of each, and its number.
        self._last: dict[str, tuple[float, int]] = {}

    def is_due(self, model: CameraModel) -> bool:
        """Return whether a picture of ``model`` is to be taken now: each is taken once."""
        now = self._simulation.time
        last, number = self._last.get(model.name, (math.inf, 0))
        # A paused run shows one moment again and again, and a reset goes back in time.
        return now <= last or self._number(model) > number

    def take(self, model: CameraModel, parts: Collection[str]) -> CameraPicture | None:
        """
        Return a picture with ``parts``; None where the place of the camera is not known.

        :param parts: among COLOR, DEPTH, LABELS and INFO
        """
        simulation = self._simulation
        frame = self._place(model) if model.frame else WORLD
        if frame is None:
            return None
        self._last[model.name] = simulation.time, self._number(model)
        if not set(parts) - {INFO}:
            return CameraPicture.without_pixels(model, model.placed(frame), simulation.time)
        camera = self._cameras.setdefault(model.name, Camera(model))
        return camera.capture(
            simulation, frame=frame, color=COLOR in parts, depth=DEPTH in parts,
            labels=LABELS in parts, normals=False, visible=False)

    def _number(self, model: CameraModel) -> int:
        """Return how many pictures are due until now: a frame ends up to a step early."""
        now = self._simulation.time + self._simulation.dt
        return math.floor(now * model.rate - _ROUNDING)

    def close(self) -> None:
        """Release the device."""
        for camera in self._cameras.values():
            camera.close()
        self._cameras.clear()
