# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A picture that a camera has taken."""

from dataclasses import dataclass

from cloth_sim_ros.sim.model.cameras import CameraModel
from cloth_sim_ros.sim.model.pose import Pose
import numpy as np


@dataclass(frozen=True)
class CameraPicture:
    """
    What a camera has seen at one time. Arrays that were not requested are None.

    :param camera: that has taken it
    :param pose: of its optical frame in the world
    :param time: simulated [s]
    :param color: (height, width, 3) uint8, red green blue, the uppermost line first
    :param depth: along the optical axis, (height, width) float32 [m]; inf where nothing is nearer
        than far, -inf where something is nearer than near (REP 117), and NaN where a camera with
        noise measures nothing
    :param labels: (height, width) uint8, places in ``label_names``
    :param normals: unit normals in the optical frame that point towards the camera, (height,
        width, 3) float32; NaN where nothing is
    :param visible: which nodes of the cloth are seen, (rows, cols) bool
    :param label_names: what each label stands for: background, cloth, then the colliders
    """

    camera: CameraModel
    pose: Pose
    time: float
    color: np.ndarray | None
    depth: np.ndarray | None
    labels: np.ndarray | None
    normals: np.ndarray | None
    visible: np.ndarray | None
    label_names: tuple[str, ...]

    @classmethod
    def without_pixels(
            cls, camera: CameraModel, pose: Pose, time: float) -> 'CameraPicture':
        """Return a picture that only says where the camera is."""
        return cls(camera, pose, time, None, None, None, None, None, ())

    def points(self) -> np.ndarray:
        """
        Return where the surface of each pixel is in the optical frame [m].

        :return: (height, width, 3) float32, the inverse of K times depth; NaN where there is none
        :raises ValueError: when the picture has no depth
        """
        if self.depth is None:
            raise ValueError('the picture has no depth: capture it with depth=True')
        return points_of(self.depth, self.camera.rays().astype(np.float32))


def points_of(depth: np.ndarray, rays: np.ndarray) -> np.ndarray:
    """
    Return the points of ``depth``, (height, width) [m], in the optical frame [m].

    :param rays: X / Z and Y / Z of each pixel, (height, width, 2) float32
    :return: (height, width, 3) float32; NaN where depth is not finite
    """
    z = np.where(np.isfinite(depth), depth, np.float32(np.nan))
    points = np.empty((*depth.shape, 3), np.float32)
    np.multiply(rays, z[..., None], out=points[..., :2])
    points[..., 2] = z
    return points
