# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a camera sees, in formulas: where a point is in the picture."""

from dataclasses import dataclass

import numpy as np

_NEAREST = 0.02  # of the distance: nothing is drawn nearer to the camera


@dataclass(frozen=True)
class View:
    """
    A picture's frame in the scene.

    :param width: [pixel]
    :param height: [pixel]
    :param axes: right, up and towards the camera, the rows of a rotation
    :param middle: the point in the middle of the picture [m], (3,)
    :param distance: from there to the camera [m]; infinite without perspective
    :param half_height: of the picture, at the middle [m]
    :param depth: how far from the middle, forth and back, is still drawn [m]
    """

    width: int
    height: int
    axes: np.ndarray
    middle: np.ndarray
    distance: float
    half_height: float
    depth: float

    @property
    def pixel(self) -> float:
        """Get the side of a pixel at the middle [m]."""
        return 2.0 * self.half_height / self.height

    @property
    def matrix(self) -> np.ndarray:
        """Get the clip coordinates of OpenGL for points relative to the middle, (4, 4)."""
        near = min(self.depth, (1.0 - _NEAREST) * self.distance)
        far = -self.depth
        shrink = 1.0 / self.distance
        # The fourth coordinate, 1 at the middle, is the distance over that of the middle.
        at_near, at_far = 1.0 - shrink * near, 1.0 - shrink * far
        slope = -(at_near + at_far) / (near - far)
        half_width = self.half_height * self.width / self.height
        right, up, towards = self.axes
        return np.stack([
            np.append(right / half_width, 0.0), np.append(up / self.half_height, 0.0),
            np.append(slope * towards, at_far - slope * far),
            np.append(-shrink * towards, 1.0)])

    def project(self, points: np.ndarray) -> np.ndarray:
        """
        Return where ``points`` are seen.

        :param points: (..., 3) [m]
        :return: (..., 2) pixels from the upper left corner of the picture, right and down
        """
        across, up, near = np.moveaxis((points - self.middle) @ self.axes.T, -1, 0)
        scale = 1.0 / (self.pixel * (1.0 - near / self.distance))
        return np.stack(
            [self.width / 2.0 + scale * across, self.height / 2.0 - scale * up], axis=-1)
