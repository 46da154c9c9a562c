# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What an environment shows of its cloth."""

from abc import ABC
from abc import abstractmethod
from collections.abc import Mapping
from collections.abc import Sequence
from typing import Any

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.arguments import integers
from cloth_sim_ros.sim.arguments import iterable
from cloth_sim_ros.sim.arguments import mapping
from cloth_sim_ros.sim.arguments import real_number
from cloth_sim_ros.sim.arguments import vector
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.pins import FARTHEST
from cloth_sim_ros.sim.simulation import Simulation
from gymnasium import spaces
import numpy as np

_MOST_PIXELS = 4096
_ANGLES = ('azimuth', 'elevation', 'field_of_view', 'zoom')
_CAMERA = f'give {", ".join(_ANGLES)} as numbers, or target as x, y and z'
Observation = np.ndarray | dict[str, np.ndarray]


class Part(ABC):
    """One array of an observation."""

    space: spaces.Box

    @abstractmethod
    def look(self, simulation: Simulation) -> np.ndarray:
        """Return the array at this time."""

    def close(self) -> None:
        """Free its memory on the device."""


class Positions(Part):
    """Where all nodes are [m], (rows, cols, 3) float32; 0 where a shape has no node."""

    def __init__(self, rows: int, cols: int) -> None:
        """Make the space."""
        self.space = spaces.Box(-FARTHEST, FARTHEST, (rows, cols, 3), np.float32)

    def look(self, simulation: Simulation) -> np.ndarray:
        """Return the array at this time."""
        return np.nan_to_num(simulation.positions(), copy=False)


class PositionsAndVelocities(Part):
    """
    Positions [m] and velocities [m/s] of all nodes, (rows, cols, 6) float32.

    They are 0 where a shape has no node.
    """

    def __init__(self, rows: int, cols: int) -> None:
        """Make the space."""
        self.space = spaces.Box(-FARTHEST, FARTHEST, (rows, cols, 6), np.float32)

    def look(self, simulation: Simulation) -> np.ndarray:
        """Return the array at this time."""
        return np.nan_to_num(np.concatenate(
            [simulation.positions(), simulation.velocities()], axis=-1), copy=False)


class Depth(Part):
    """
    A depth picture [m], (height, width) float32, its uppermost line first.

    :param points: what the camera has in view, (n, 3) [m]
    :param camera: azimuth, elevation, field_of_view [deg] and zoom, where they differ from the
        defaults of ``cloth_sim render``
    :param size: height and width [pixel]
    """

    def __init__(
            self, points: np.ndarray, camera: Mapping[str, Any], size: Sequence[int]) -> None:
        """Place the camera."""
        # Drawing takes longer to import than the rest, and most environments do without.
        from cloth_sim_ros.camera.camera import Camera
        from cloth_sim_ros.rendering.camera import Camera as Place
        height, width = _checked_size(size)
        view = Place(**_checked_camera(camera)).looking_at(points, width, height)
        self._camera = Camera(view.pinhole())
        self.space = spaces.Box(0.0, self._camera.model.far, (height, width), np.float32)

    def look(self, simulation: Simulation) -> np.ndarray:
        """Return the array at this time."""
        depth = self._camera.capture(
            simulation, color=False, labels=False, normals=False, visible=False).depth
        assert depth is not None
        # What is nearer than the camera measures is at it, and where nothing is, there is far.
        return np.clip(depth, 0.0, np.float32(self._camera.model.far))

    def close(self) -> None:
        """Free its memory on the device."""
        self._camera.close()


_CHOOSE = 'choose one, or several for a dictionary'
PARTS = ('positions', 'state', 'depth')


class Observer:
    """
    Looks at a simulation as the environment was asked to.

    :param asked: one of PARTS for an array, or several for a dictionary of arrays
    :param shape: rows and columns of the cloth
    :param points: what a camera has in view, (n, 3) [m]
    :raises ClothSimError: when a value is wrong
    """

    def __init__(
            self, asked: str | Sequence[str], shape: tuple[int, int], points: np.ndarray,
            camera: Mapping[str, Any], size: Sequence[int]) -> None:
        """Make the parts and their space."""
        names = _checked_names(asked)
        if 'depth' in names and min(shape) < 2:
            raise ClothSimError(
                f'a depth picture needs a surface, but the cloth has {shape[0]} x {shape[1]} '
                'nodes: give 2 or more along each side')
        self._is_one = isinstance(asked, str)
        self._parts: dict[str, Part] = {}
        for name in names:
            if name == 'depth':
                self._parts[name] = Depth(points, camera, size)
            elif name == 'state':
                self._parts[name] = PositionsAndVelocities(*shape)
            else:
                self._parts[name] = Positions(*shape)
        self.space: spaces.Space[Any] = (
            self._parts[names[0]].space if self._is_one else
            spaces.Dict({name: part.space for name, part in self._parts.items()}))

    def look(self, simulation: Simulation) -> Observation:
        """Return the observation at this time."""
        seen = {name: part.look(simulation) for name, part in self._parts.items()}
        return next(iter(seen.values())) if self._is_one else seen

    def close(self) -> None:
        """Free its memory on the device."""
        for part in self._parts.values():
            part.close()


def _checked_names(asked: str | Sequence[str]) -> list[str]:
    names = [asked] if isinstance(asked, str) else iterable(asked, 'an observation', _CHOOSE)
    are_known = all(isinstance(name, str) and name in PARTS for name in names)
    if not names or not are_known or len(set(names)) < len(names):
        raise ClothSimError(
            f'an observation must be {", ".join(PARTS[:-1])} or {PARTS[-1]}, or a list of them, '
            f'got {shown(asked)}: {_CHOOSE}')
    return names


def _checked_camera(given: Mapping[str, Any]) -> dict[str, Any]:
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


def _checked_size(size: Sequence[int]) -> tuple[int, int]:
    sides = integers(size, 'the size of a picture', 'give two whole numbers, height and width')
    if sides.shape != (2,) or not np.all((sides >= 1) & (sides <= _MOST_PIXELS)):
        raise ClothSimError(
            f'the size of a picture must be a height and a width from 1 to {_MOST_PIXELS} pixels, '
            f'got {shown(size)}: give two whole numbers')
    height, width = sides.tolist()
    return height, width
