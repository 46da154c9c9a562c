# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The camera of an environment, for depth that it observes and for colours that people look at."""

from collections.abc import Mapping
from collections.abc import Sequence
from typing import Any
from typing import Protocol
from typing import TYPE_CHECKING

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.arguments import integers
from cloth_sim_ros.sim.arguments import mapping
from cloth_sim_ros.sim.arguments import real_number
from cloth_sim_ros.sim.arguments import vector
from cloth_sim_ros.sim.batch_cloth import ClothOfBatch
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np

if TYPE_CHECKING:
    from cloth_sim_ros.camera.camera import Camera

RGB_ARRAY = 'rgb_array'
_MOST_PIXELS = 4096
_ANGLES = ('azimuth', 'elevation', 'field_of_view', 'zoom')
_CAMERA = f'give {", ".join(_ANGLES)} as numbers, or target as x, y and z'


class Viewed(Protocol):
    """What there is to see."""

    def views(self) -> Sequence[Simulation | ClothOfBatch]:
        """Return each cloth."""


class Posed(Protocol):
    """What a task says of its pictures."""

    scene: Scene
    camera: Mapping[str, Any]
    render_size: Sequence[int]

    @property
    def seen(self) -> np.ndarray:
        """Return what the camera should have in view, (n, 3) [m]."""


class Pictures:
    """
    Takes pictures of the cloths of a task, each by itself, in colour.

    :param mode: rgb_array; None for no pictures
    :raises ClothSimError: when the mode, the camera or the size is wrong
    """

    def __init__(self, task: Posed, mode: str | None) -> None:
        """Place the camera."""
        self.mode = _checked_mode(mode)
        self._camera = None if self.mode is None else camera_for(
            checked_angles(task.camera), task, checked_size(task.render_size))

    def take(self, cloths: Viewed) -> tuple[np.ndarray, ...]:
        """Return a picture of each cloth, (height, width, 3) uint8."""
        if self._camera is None:
            raise ClothSimError(
                'render needs a render_mode, got None: make the environment with '
                f"render_mode='{RGB_ARRAY}'")
        pictures = [
            self._camera.capture(
                cloth, depth=False, labels=False, normals=False, visible=False).color
            for cloth in cloths.views()]
        return tuple(picture for picture in pictures if picture is not None)

    def close(self) -> None:
        """Free its memory on the device."""
        if self._camera is not None:
            self._camera.close()


def camera_for(
        angles: Mapping[str, Any], task: Posed, size: tuple[int, int]) -> 'Camera':
    """
    Return the camera that sees where the cloth of ``task`` begins and goes.

    :param angles: as ``checked_angles`` returns them
    :param size: height and width [pixel]
    :raises ClothSimError: for a chain, which has no surface
    """
    rows, cols = task.scene.rows, task.scene.cols
    if min(rows, cols) < 2:
        raise ClothSimError(
            f'a picture needs a surface, but the cloth has {rows} x {cols} nodes: give 2 or more '
            'along each side')
    # Drawing takes longer to import than the rest, and most environments do without.
    from cloth_sim_ros.camera.camera import Camera
    from cloth_sim_ros.rendering.camera import Camera as Place
    height, width = size
    return Camera(Place(**angles).looking_at(task.seen, width, height).pinhole())


def _checked_mode(mode: str | None) -> str | None:
    if mode is not None and (not isinstance(mode, str) or mode != RGB_ARRAY):
        raise ClothSimError(
            f'a render_mode must be {RGB_ARRAY} or None, got {shown(mode)}: give one of them')
    return mode


def checked_angles(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return what places a camera, or raise ClothSimError where a value is wrong."""
    found: dict[str, Any] = {}
    for name, value in mapping(given, 'the camera', _CAMERA).items():
        if name not in _ANGLES and name != 'target':
            raise ClothSimError(f'a camera has no {shown(name)}: {_CAMERA}')
        if name == 'target':
            value = None if value is None else vector(value, 'the target of a camera')
        else:
            value = real_number(value, f'the {name} of a camera', _CAMERA)
        found[name] = value
    return found


def checked_size(size: Sequence[int]) -> tuple[int, int]:
    """Return height and width of a picture, or raise ClothSimError when there is no such one."""
    sides = integers(size, 'the size of a picture', 'give two whole numbers, height and width')
    if sides.shape != (2,) or not np.all((sides >= 1) & (sides <= _MOST_PIXELS)):
        raise ClothSimError(
            f'the size of a picture must be a height and a width from 1 to {_MOST_PIXELS} pixels, '
            f'got {shown(size)}: give two whole numbers')
    height, width = sides.tolist()
    return height, width
