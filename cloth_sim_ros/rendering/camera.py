# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""From where the cloth is looked at, and how that projects."""

from dataclasses import dataclass
import math

from cloth_sim_ros.gl.program import RenderProgram
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.cameras import CameraModel
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.pose import quaternion_of
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

    def pinhole(self, name: str = 'view') -> CameraModel:
        """
        Return the camera that sees this view.

        :raises ClothSimError: when it has no perspective, and the camera therefore no place
        """
        if not math.isfinite(self.distance):
            raise ClothSimError(
                'a camera needs a field of view above 0 degrees, got 0: give one')
        right, up, towards = self.axes
        x, y, z = self.middle + self.distance * towards
        focal = self.distance / self.pixel
        return CameraModel(
            name, self.width, self.height, focal, focal, (self.width - 1) / 2.0,
            (self.height - 1) / 2.0,
            Pose((x, y, z), quaternion_of(np.stack([right, -up, -towards]))), '',
            near=max(_NEAREST * self.distance, self.distance - self.depth),
            far=float(np.float32(self.distance + self.depth)), rate=1.0)

    def sees(self, collider: Collider) -> bool:
        """Return whether it is no plane, or the camera is on the side of it that cloth is on."""
        if collider.shape != 'plane':
            return True
        return self._is_before(collider.axes[2], np.array(collider.position))

    def is_above(self, height: float) -> bool:
        """Return whether the camera looks at the upper side of a floor at ``height`` [m]."""
        return self._is_before(np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, height]))

    def _is_before(self, normal: np.ndarray, point: np.ndarray) -> bool:
        if not math.isfinite(self.distance):
            return bool(normal @ self.axes[2] > 0.0)
        eye = self.middle + self.distance * self.axes[2]
        return bool(normal @ (eye - point) > 0.0)

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

    def may_show(self, corners: np.ndarray) -> bool:
        """
        Return whether something between ``corners`` can be in the picture.

        It cannot be where all corners are beyond the same side of the picture.

        :param corners: (n, 3) [m]; without one, nothing is in the picture
        """
        if not len(corners):
            return False
        across, up, near = ((corners - self.middle) @ self.axes.T).T
        half_height = self.half_height * (1.0 - near / self.distance)
        half_width = half_height * self.width / self.height
        inside = half_width - across, half_width + across, half_height - up, half_height + up
        return all(float(distance.max()) >= 0.0 for distance in inside)

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
