# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A pinhole camera at a place, as the shaders of shaders/camera need it."""

from dataclasses import dataclass
from functools import cached_property

from cloth_sim_ros.gl.program import RenderProgram
from cloth_sim_ros.sim.model.cameras import CameraModel
from cloth_sim_ros.sim.model.pose import Pose
import numpy as np


@dataclass(frozen=True)
class Lens:
    """
    A camera at a place.

    :param pose: of its optical frame in the world
    """

    model: CameraModel
    pose: Pose

    @cached_property
    def matrix(self) -> np.ndarray:
        """Return the clip coordinates of OpenGL for points relative to the eye, (4, 4)."""
        model = self.model
        near, far = model.near, model.far
        right, down, forward = self.pose.axes
        # A pixel's middle is half a pixel off its corner; the first line is the lowest one.
        across = 2.0 * (model.fx * right + (model.cx + 0.5) * forward) / model.width - forward
        along = 2.0 * (model.fy * down + (model.cy + 0.5) * forward) / model.height - forward
        depth = (far + near) / (far - near)
        return np.stack([
            np.append(across, 0.0), np.append(along, 0.0),
            np.append(depth * forward, -2.0 * far * near / (far - near)),
            np.append(forward, 0.0)])

    def set_eye_in(self, program: RenderProgram) -> None:
        """Set the place of the eye in ``program``, which is in use."""
        eye = np.array(self.pose.position)
        program.set_vectors('eye', eye)
        program.set_vectors('eye_rest', eye - eye.astype(np.float32))

    def set_in(self, program: RenderProgram) -> None:
        """Set the uniforms of camera/pinhole.glsl in ``program``, which is in use."""
        model = self.model
        self.set_eye_in(program)
        program.set_vectors('optical_axes', self.pose.axes)
        program.set_floats(
            'pinhole', (model.fx, model.fy, model.cx, model.cy, model.near, model.far))
        program.set_matrix('picture_matrix', self.matrix)

    def rectangle(self, corners: np.ndarray) -> tuple[int, int, int, int] | None:
        """
        Return the part of the picture that is around ``corners``, of a convex body.

        :param corners: (n, 3) of the world [m]
        :return: first pixel, across and down, and how many; None where it is not in the picture
        """
        model = self.model
        seen = self.pose.seen_from(corners)
        if (seen[:, 2] > model.far).all() or (seen[:, 2] <= 0.0).all():
            return None
        if (seen[:, 2] < model.near).any():
            # What reaches behind the eye can be anywhere.
            return 0, 0, model.width, model.height
        size = np.array([model.width, model.height])
        pixels = model.project(seen)
        low = np.clip(np.floor(pixels.min(axis=0)), 0, size).astype(int)
        high = np.clip(np.ceil(pixels.max(axis=0)) + 1.0, 0, size).astype(int)
        if (high <= low).any():
            return None
        return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])
