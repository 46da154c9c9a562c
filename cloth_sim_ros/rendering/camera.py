# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""From where the cloth is looked at, how that projects, and what a depth camera sees."""

from collections.abc import Sequence
from dataclasses import dataclass
import math

from cloth_sim_ros.analysis.collider_surface import collider_surface
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.framebuffer import DepthBuffer
from cloth_sim_ros.gl.framebuffer import draw_nearest
from cloth_sim_ros.gl.program import RenderProgram
from cloth_sim_ros.rendering.node_buffer import NodeBuffer
from cloth_sim_ros.rendering.surface_programs import draw_surface
from cloth_sim_ros.rendering.surface_programs import GAP_DEFINES
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.snapshot import FLAG_GAP
import numpy as np

_NEAREST = 0.02  # of the distance: nothing is drawn nearer to the camera
_MARGIN = 1.06        # size of the picture over that of what must be in it
_WIDEST = 150.0       # [deg]
_LEAST_VIEW = 1e-3    # half the height of a picture of one point, over the size of the scene
_CLEAR = 1.1          # distance of the camera over that of what is nearest to it
_SMALLEST = 1e-6      # a scene of one point still has a size [m]
_DEEP = 4.0           # what is drawn around the scene, over its size


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
        slope, offset = self._depth_line
        shrink = 1.0 / self.distance
        half_width = self.half_height * self.width / self.height
        right, up, towards = self.axes
        return np.stack([
            np.append(right / half_width, 0.0), np.append(up / self.half_height, 0.0),
            np.append(slope * towards, offset),
            np.append(-shrink * towards, 1.0)])

    def distances(self, depths: np.ndarray) -> np.ndarray:
        """
        Return how far from the camera, along its axis, something is [m]; with perspective only.

        :param depths: of OpenGL, 0 at the near end to 1 at the far one
        """
        slope, offset = self._depth_line
        device = 2.0 * depths.astype(float) - 1.0
        return self.distance - (device - offset) / (slope + device / self.distance)

    def sees(self, collider: Collider) -> bool:
        """Return whether it is no plane, or the camera is on the side of it that cloth is on."""
        if collider.shape != 'plane':
            return True
        normal = collider.axes[2]
        if not math.isfinite(self.distance):
            return bool(normal @ self.axes[2] > 0.0)
        eye = self.middle + self.distance * self.axes[2]
        return bool(normal @ (eye - np.array(collider.position)) > 0.0)

    @property
    def _depth_line(self) -> tuple[float, float]:
        """Get slope and offset of the third clip coordinate, over what is nearer by [m]."""
        near = min(self.depth, (1.0 - _NEAREST) * self.distance)
        far = -self.depth
        shrink = 1.0 / self.distance
        # The fourth coordinate, 1 at the middle, is the distance over that of the middle.
        at_near, at_far = 1.0 - shrink * near, 1.0 - shrink * far
        slope = -(at_near + at_far) / (near - far)
        return slope, at_far - slope * far

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


@dataclass(frozen=True)
class Camera:
    """
    Looks at the scene, with z up.

    :param azimuth: direction it stands in, counted from x towards y [deg]
    :param elevation: how far above the horizon it stands [deg]
    :param field_of_view: angle between the upper and the lower end of the picture [deg]; 0 is a
        camera without perspective
    :param zoom: 1 shows everything, 2 half as much along each side
    :param target: the point in the middle of the picture [m]; None puts everything there
    :raises ClothSimError: for angles and zooms that show nothing
    """

    azimuth: float = -55.0
    elevation: float = 22.0
    field_of_view: float = 25.0
    zoom: float = 1.0
    target: tuple[float, float, float] | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        values = (self.azimuth, self.elevation, self.field_of_view, self.zoom,
                  *(self.target or ()))
        if not all(map(math.isfinite, values)):
            raise ClothSimError(f'a camera needs finite values, got {values}: give numbers')
        if not 0.0 <= self.field_of_view <= _WIDEST:
            raise ClothSimError(
                f'the field of view must be from 0 to {_WIDEST:g} degrees, got '
                f'{self.field_of_view:g}: 0 is a camera without perspective')
        if self.zoom <= 0.0:
            raise ClothSimError(f'the zoom must be above 0, got {self.zoom:g}: 1 shows everything')

    @property
    def axes(self) -> np.ndarray:
        """Right, up and towards the camera, as the rows of a rotation."""
        azimuth, elevation = math.radians(self.azimuth), math.radians(self.elevation)
        right = (-math.sin(azimuth), math.cos(azimuth), 0.0)
        towards = (
            math.cos(azimuth) * math.cos(elevation), math.sin(azimuth) * math.cos(elevation),
            math.sin(elevation))
        return np.array([right, np.cross(towards, right), towards])

    def looking_at(self, points: np.ndarray, width: int, height: int) -> View:
        """
        Return the view of ``width`` x ``height`` pixels that all ``points`` are in, at zoom 1.

        :param points: (n, 3) [m]
        """
        low, high = points.min(axis=0), points.max(axis=0)
        middle = (low + high) / 2.0 if self.target is None else np.array(self.target, float)
        size = max(float(np.linalg.norm(high - low)), _SMALLEST)
        across, up, near = ((points - middle) @ self.axes.T).T
        tangent = math.tan(math.radians(self.field_of_view) / 2.0)
        # In perspective, what is nearer by z looks larger: |x| / slope + z must not be above the
        # distance. That asks for the same as a parallel view of x + slope z.
        slope = tangent / _MARGIN
        sides = [
            self._side(across, near, slope * width / height), self._side(up, near, slope)]
        half_height = _MARGIN * max(
            sides[0][1] * height / width, sides[1][1], size * _LEAST_VIEW,
            # A wide camera would stand within the cloth.
            slope * _CLEAR * float(near.max()))
        middle = middle + sides[0][0] * self.axes[0] + sides[1][0] * self.axes[1]
        distance = half_height / tangent if tangent > 0.0 else math.inf
        return View(
            width=width, height=height, axes=self.axes, middle=middle, distance=distance,
            half_height=half_height / self.zoom, depth=_DEEP * (
                size + float(np.linalg.norm((low + high) / 2.0 - middle))))

    def _side(self, places: np.ndarray, near: np.ndarray, slope: float) -> tuple[float, float]:
        """Return the middle and half the length of what is seen along one side."""
        upper = float(np.max(places + slope * near))
        lower = float(np.max(slope * near - places))
        if self.target is not None:
            return 0.0, max(upper, lower)
        return (upper - lower) / 2.0, (upper + lower) / 2.0


def set_view(program: RenderProgram, view: View, detail: int = 1) -> None:
    """
    Set the uniforms of render/view.glsl in ``program``, which is in use.

    :param detail: drawn pixels along each side of a pixel of the picture
    """
    program.set_matrix('view_matrix', view.matrix)
    program.set_vectors('towards_camera', view.axes[2])
    program.set_pair('half_size', (detail * view.width / 2.0, detail * view.height / 2.0))


# See a cloth and its colliders as a depth camera does.

_PLANE = 4.0  # half the side of a plane, over how far from the middle is drawn


class DepthCamera:
    """
    Draws how far away a cloth and what it can touch are, along the axis of the camera.

    It has a GL context of its own.

    :param cells: which there are, (rows - 1, cols - 1) bool; None for all
    :raises ClothSimError: when the view has no perspective, and the camera therefore no place
    :raises DeviceError: when there is no GL device, or it can't draw so large a picture
    """

    def __init__(self, view: View, cells: np.ndarray | None = None) -> None:
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
        self._flags = None if cells is None else FLAG_GAP * np.pad(~cells, ((0, 1), (0, 1)))
        self._surface = RenderProgram('render/cloth.vert', 'render/plain.frag')
        self._cut_surface = None if cells is None else RenderProgram(
            'render/cloth.vert', 'render/plain.frag', GAP_DEFINES)

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
        if self._cut_surface is not None:
            self._nodes.load_points(positions, self.view.middle, self._flags)
            self._cut_surface.use()
            set_view(self._cut_surface, self.view)
            draw_surface(self._cut_surface, positions.shape[:2], has_gaps=True)
        self._surface.use()
        set_view(self._surface, self.view)
        if self._cut_surface is None:
            self._draw(positions)
        for collider in colliders:
            if self.view.sees(collider):
                self._draw(collider_surface(
                    collider, self.view.middle, _PLANE * self.view.depth)[0])
        drawn = self._depths.read()
        depths = self.view.distances(drawn).astype(np.float32)
        return np.where(drawn < 1.0, depths, np.float32(self.far))

    def _draw(self, points: np.ndarray) -> None:
        self._nodes.load_points(points, self.view.middle)
        draw_surface(self._surface, points.shape[:2])

    def close(self) -> None:
        """Release the device."""
        self._context.close()
