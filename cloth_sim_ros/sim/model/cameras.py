# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pinhole cameras of a scene: their parameters, their poses, and how they project."""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import dataclass
from dataclasses import replace
import math
from typing import Any

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.arguments import instance
from cloth_sim_ros.sim.arguments import vectors
from cloth_sim_ros.sim.arguments import word
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.body_names import check_names
from cloth_sim_ros.sim.model.body_names import fields_of_names
from cloth_sim_ros.sim.model.pose import NO_ROTATION
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.pose import quaternion_of
from cloth_sim_ros.sim.model.pose import unit_quaternion
from cloth_sim_ros.sim.model.scene_fields import Field
import numpy as np

NAMES = 'cameras.names'
# Max. cameras [1]; chosen, more than any robot cell has.
MOST_CAMERAS = 16
# Largest side of a picture [pixel]: its depth alone takes 64 MiB.
MOST_PIXELS = 4096
# Least distance from a camera to its target [m].
_NEAREST_TARGET = 1e-6

# NAME stands for each of cameras.names.
CAMERA_FIELDS = (
    Field('cameras.NAME.width', int, 640, 'width of the pictures', 'pixel', low=1,
          high=MOST_PIXELS),
    Field('cameras.NAME.height', int, 480, 'height of the pictures', 'pixel', low=1,
          high=MOST_PIXELS),
    Field('cameras.NAME.field_of_view', float, 60.0, 'angle between the left and the right edge '
          'of the picture; not used with intrinsics', 'deg', low=1.0, high=170.0),
    Field('cameras.NAME.intrinsics', float, (), 'fx fy cx cy of the pinhole, where the middle of '
          'the upper left pixel is (0, 0); empty for those of field_of_view', 'pixel', low=-1e6,
          high=1e6, is_array=True),
    Field('cameras.NAME.frame', str, '', 'tf frame that the camera is rigidly attached to; empty '
          'for the frame of the cloth', words='the name of a frame on /tf'),
    Field('cameras.NAME.position', float, (0.0, 0.0, 0.0), 'of the camera in that frame, x y z',
          'm', low=-1e5, high=1e5, is_array=True),
    Field('cameras.NAME.orientation', float, (), 'of the optical frame (x right, y down, z '
          'forward) in that frame, quaternion x y z w; empty to look at target, or for none in a '
          'tf frame', low=-1e3, high=1e3, is_array=True),
    Field('cameras.NAME.target', float, (), 'point that a camera without a tf frame looks at, x y '
          'z, with z up in the picture', 'm', low=-1e5, high=1e5, is_array=True),
    Field('cameras.NAME.near', float, 0.05, 'depth below which nothing is measured', 'm',
          low=1e-3, high=1e4),
    Field('cameras.NAME.far', float, 10.0, 'depth above which nothing is seen', 'm', low=1e-2,
          high=1e5),
    Field('cameras.NAME.samples', int, 4, 'samples of the colour of each pixel, as far as the '
          'device has them; 1 leaves outlines jagged, in half the time on a software device',
          low=1, high=16),
    Field('cameras.NAME.noise_baseline', float, 0.0, 'distance of the two eyes of a depth sensor '
          'that triangulates, whose noise the depth has; 0 for no noise', 'm', low=0.0, high=1e3),
    Field('cameras.NAME.noise_disparity', float, 0.5, 'standard deviation of the disparity that '
          'it measures', 'pixel', low=0.0, high=1e3),
    Field('cameras.NAME.noise_step', float, 0.125, 'step of that disparity; 0 for none', 'pixel',
          low=0.0, high=1e3),
    Field('cameras.NAME.noise_edge', float, 0.02, 'jump of the depth beside which it measures '
          'nothing; 0 to measure everywhere', 'm', low=0.0, high=1e5),
    Field('cameras.NAME.noise_seed', int, 0, 'random seed of the noise', low=0, high=2**31 - 1),
    Field('cameras.NAME.rate', float, 30.0, 'pictures per second of simulated time, each taken '
          'with the next frame of publish.rate', 'Hz', low=1e-3,
          high=1e3),
)
# As arguments of a function, without the prefix.
_FIELD_OF = {field.name.rpartition('.')[2]: field for field in CAMERA_FIELDS}


@dataclass(frozen=True)
class DepthNoise:
    """
    The noise of a depth sensor that triangulates (camera/depth_noise.py).

    :param baseline: distance of its two eyes [m]
    :param disparity: standard deviation of the disparity that it measures [pixel]
    :param step: of that disparity [pixel]; 0 for none
    :param edge: jump of the depth beside which it measures nothing [m]; 0 to measure everywhere
    :param seed: of the random numbers
    """

    baseline: float
    disparity: float
    step: float
    edge: float
    seed: int


@dataclass(frozen=True)
class CameraModel:
    """
    A pinhole camera without distortion.

    A point (X, Y, Z) [m] of its optical frame (x right, y down, z forward, REP 103) is seen at
    (fx X / Z + cx, fy Y / Z + cy) [pixel], where (0, 0) is the middle of the upper left pixel.

    :param name: of its own in the scene
    :param width: of the pictures [pixel]
    :param height: of the pictures [pixel]
    :param fx: focal length along a line [pixel]
    :param fy: focal length along a column [pixel]
    :param cx: where the optical axis is along a line [pixel]
    :param cy: where it is along a column [pixel]
    :param pose: of the optical frame in ``frame``
    :param frame: of tf; empty for that of the cloth
    :param near: depth below which nothing is measured [m]
    :param far: depth above which nothing is seen [m]
    :param rate: pictures per simulated time [Hz]
    :param samples: of the colour of a pixel
    :param noise: of the depth; None for none
    """

    name: str
    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    pose: Pose
    frame: str
    near: float
    far: float
    rate: float
    samples: int = 4
    noise: DepthNoise | None = None

    @classmethod
    def of(cls, name: str = 'camera', **values: Any) -> CameraModel:
        """
        Return the camera with ``values`` of cameras.NAME.*, by name; others have their defaults.

        :raises ClothSimError: for an unknown name or a wrong value
        """
        word(name, 'the name of a camera')
        for key in values:
            if key not in _FIELD_OF:
                raise ClothSimError(
                    f'a camera has no {cut(key)}: give one of {", ".join(_FIELD_OF)}')
        prefix = f'cameras.{name}'
        checked = {}
        for key, field in _FIELD_OF.items():
            value = values.get(key, field.default)
            plain = value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value
            checked[f'{prefix}.{key}'] = replace(field, name=f'{prefix}.{key}').check(plain)
        return camera_of(checked, name)

    @property
    def matrix(self) -> np.ndarray:
        """Return K of the pinhole, (3, 3)."""
        return np.array([
            (self.fx, 0.0, self.cx), (0.0, self.fy, self.cy), (0.0, 0.0, 1.0)])

    def project(self, points: np.ndarray) -> np.ndarray:
        """
        Return where ``points`` of the optical frame, (..., 3) [m], are seen, (..., 2).

        :raises ClothSimError: when they are no such numbers
        """
        x, y, z = np.moveaxis(vectors(points, 'the points to project'), -1, 0)
        with np.errstate(divide='ignore', invalid='ignore'):
            return np.stack([self.fx * x / z + self.cx, self.fy * y / z + self.cy], axis=-1)

    def rays(self) -> np.ndarray:
        """Return X / Z and Y / Z of what each pixel sees, (height, width, 2)."""
        u, v = np.meshgrid(np.arange(self.width), np.arange(self.height))
        return np.stack([(u - self.cx) / self.fx, (v - self.cy) / self.fy], axis=-1)

    def placed(self, frame: Pose) -> Pose:
        """
        Return the pose of the optical frame in the world, where its frame is at ``frame``.

        :raises ClothSimError: when that is no Pose
        """
        instance(frame, Pose, 'the frame of a camera', 'give where its tf frame is in the world')
        return frame.placed(self.pose)


def camera_fields(given: Mapping[str, Any]) -> tuple[Field, ...]:
    """Return the fields of each camera that ``given`` names; names that are wrong have none."""
    return fields_of_names(given.get(NAMES), MOST_CAMERAS, CAMERA_FIELDS)


def cameras_of(values: Mapping[str, Any]) -> tuple[CameraModel, ...]:
    """
    Return the cameras that checked scene ``values`` describe, in the order of their names.

    :raises ClothSimError: when a name or a value is wrong
    """
    check_names(values[NAMES], NAMES, 'camera', MOST_CAMERAS)
    return tuple(camera_of(values, name) for name in values[NAMES])


def camera_of(values: Mapping[str, Any], name: str) -> CameraModel:
    """
    Return the camera ``name`` that the checked ``values`` of its fields describe.

    :raises ClothSimError: when they do not go together
    """
    group = f'cameras.{name}'
    width, height = values[f'{group}.width'], values[f'{group}.height']
    near, far = values[f'{group}.near'], values[f'{group}.far']
    if near >= far:
        raise ClothSimError(
            f'{group}.near {near:g} m must be below {group}.far {far:g} m: nothing would be seen')
    fx, fy, cx, cy = _intrinsics(values, group, width, height)
    return CameraModel(
        name, width, height, fx, fy, cx, cy, _pose(values, group), values[f'{group}.frame'],
        near, far, values[f'{group}.rate'], values[f'{group}.samples'], _noise(values, group))


def _noise(values: Mapping[str, Any], group: str) -> DepthNoise | None:
    numbers = {
        name: values[f'{group}.noise_{name}'] for name in (
            'baseline', 'disparity', 'step', 'edge', 'seed')}
    return DepthNoise(**numbers) if numbers['baseline'] > 0.0 else None


def _intrinsics(
        values: Mapping[str, Any], group: str, width: int, height: int) -> tuple[float, ...]:
    given = values[f'{group}.intrinsics']
    if not given:
        half_angle = math.radians(values[f'{group}.field_of_view']) / 2.0
        focal = width / (2.0 * math.tan(half_angle))
        return focal, focal, (width - 1) / 2.0, (height - 1) / 2.0
    _check_count(given, f'{group}.intrinsics', 4, '[fx, fy, cx, cy]')
    for what, value in zip(('fx', 'fy'), given):
        if value <= 0.0:
            raise ClothSimError(
                f'{group}.intrinsics has {what} {value:g}: give a focal length above 0 pixels')
    return tuple(given)


def _pose(values: Mapping[str, Any], group: str) -> Pose:
    position = values[f'{group}.position']
    orientation, target = values[f'{group}.orientation'], values[f'{group}.target']
    frame = values[f'{group}.frame']
    _check_count(position, f'{group}.position', 3, '[x, y, z]')
    px, py, pz = position
    if orientation and target:
        raise ClothSimError(
            f'{group}.orientation and {group}.target both say where the camera looks: give one '
            'of them')
    if target and frame:
        raise ClothSimError(
            f'{group}.target is a point of the world, and the camera is attached to the frame '
            f'{shown(frame)}: give {group}.orientation instead')
    if orientation:
        return Pose((px, py, pz), unit_quaternion(orientation, f'{group}.orientation'))
    if frame:
        return Pose((px, py, pz), NO_ROTATION)
    if not target:
        raise ClothSimError(
            f'{group} looks nowhere: give {group}.target, a point [x, y, z], or '
            f'{group}.orientation')
    _check_count(target, f'{group}.target', 3, '[x, y, z]')
    if math.dist(position, target) < _NEAREST_TARGET:
        raise ClothSimError(
            f'{group}.target is where the camera is, {list(position)}: give a point in front '
            'of it')
    return looking_at((px, py, pz), target)


def looking_at(position: tuple[float, float, float], target: Sequence[float]) -> Pose:
    """
    Return the optical frame at ``position`` [m] that looks at ``target`` [m].

    z of the world is up in the picture; for a camera that looks straight up or down, y is.
    """
    forward = np.subtract(target, position, dtype=float)
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    length = float(np.linalg.norm(right))
    right = right / length if length > _NEAREST_TARGET else np.array([1.0, 0.0, 0.0])
    return Pose(position, quaternion_of(np.stack([right, np.cross(forward, right), forward])))


def _check_count(given: Sequence[float], name: str, count: int, form: str) -> None:
    if len(given) != count:
        raise ClothSimError(f'{name} needs {count} numbers, got {len(given)}: write {form}')
