# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""See a cloth and its colliders as a depth camera does."""

from collections.abc import Sequence
import math

from cloth_sim_ros.analysis.collider_surface import collider_surface
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.framebuffer import DepthBuffer
from cloth_sim_ros.gl.framebuffer import draw_nearest
from cloth_sim_ros.gl.program import RenderProgram
from cloth_sim_ros.rendering.camera import set_view
from cloth_sim_ros.rendering.camera import View
from cloth_sim_ros.rendering.node_buffer import NodeBuffer
from cloth_sim_ros.sim.colliders import Collider
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np

_PLANE = 4.0  # half the side of a plane, over how far from the middle is drawn


class DepthCamera:
    """
    Draws how far away a cloth and what it can touch are, along the axis of the camera.

    It has a GL context of its own.

    :raises ClothSimError: when the view has no perspective, and the camera therefore no place
    :raises DeviceError: when there is no GL device, or it can't draw so large a picture
    """

    def __init__(self, view: View) -> None:
        """Make the context and the picture."""
        if not math.isfinite(view.distance):
            raise ClothSimError(
                'a depth camera needs a field of view above 0 degrees, got 0: give one')
        self.view = view
        self._context = Context()
        if not self._context.max_texture_texels:
            raise DeviceError(
                f'{self._context.device} lacks texture buffers, which rendering needs: render on '
                'another device')
        self._depths = DepthBuffer(view.width, view.height)
        self._nodes = NodeBuffer(self._context.max_texture_texels)
        self._surface = RenderProgram('render/cloth.vert', 'render/plain.frag')

    @property
    def far(self) -> float:
        """Get what pixels have in which nothing is seen [m]; farther off, nothing is."""
        return float(np.float32(self.view.distance + self.view.depth))

    def draw(
            self, positions: np.ndarray, colliders: Sequence[Collider] = ()) -> np.ndarray:
        """
        Return the depth of each pixel.

        :param positions: (rows, cols, 3) [m], of two rows and two columns or more
        :param colliders: where they are at the time
        :return: (height, width) float32 [m], the uppermost line first
        """
        self._context.make_current()
        self._depths.begin()
        draw_nearest()
        self._surface.use()
        set_view(self._surface, self.view)
        self._draw(positions)
        for collider in colliders:
            if self.view.sees(collider):
                self._draw(collider_surface(
                    collider, self.view.middle, _PLANE * self.view.depth)[0])
        drawn = self._depths.read()
        depths = self.view.distances(drawn).astype(np.float32)
        return np.where(drawn < 1.0, depths, np.float32(self.far))

    def _draw(self, points: np.ndarray) -> None:
        rows, cols = points.shape[:2]
        self._nodes.load_points(points, self.view.middle)
        self._surface.set_int('cols', cols)
        self._surface.draw_strips(2 * cols, rows - 1)

    def close(self) -> None:
        """Give the device back."""
        self._context.close()
