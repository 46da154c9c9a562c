# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What an environment shows of its cloths."""

from abc import ABC
from abc import abstractmethod
from collections.abc import Sequence
from typing import Any
from typing import Protocol

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.gym.own_functions import asked
from cloth_sim_ros.gym.own_functions import checked_function
from cloth_sim_ros.gym.own_functions import OwnFunction
from cloth_sim_ros.gym.pictures import camera_for
from cloth_sim_ros.gym.pictures import checked_angles
from cloth_sim_ros.gym.pictures import checked_size
from cloth_sim_ros.gym.pictures import Posed
from cloth_sim_ros.gym.pictures import Viewed
from cloth_sim_ros.sim.arguments import iterable
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.pins import FARTHEST
from gymnasium import spaces
import numpy as np

Observation = np.ndarray | dict[str, np.ndarray]


class Moving(Viewed, Protocol):
    """What there is to observe."""

    def positions(self) -> np.ndarray:
        """Return all positions [m], (n, rows, cols, 3) float32."""

    def velocities(self) -> np.ndarray:
        """Return all velocities [m/s], (n, rows, cols, 3) float32."""


class Observed(Posed, Protocol):
    """What a task says of its observations."""

    observation: str | Sequence[str] | OwnFunction
    picture_size: Sequence[int]

    def at_start(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return positions and velocities of ``count`` cloths at the start."""


class Part(ABC):
    """One array of an observation."""

    space: spaces.Box

    @abstractmethod
    def look(self, cloths: Moving) -> np.ndarray:
        """Return the array of each cloth at this time, (n, ...)."""

    def close(self) -> None:
        """Free its memory on the device."""


class Positions(Part):
    """Where all nodes are [m], (rows, cols, 3) float32; 0 where a shape has no node."""

    def __init__(self, rows: int, cols: int) -> None:
        """Make the space."""
        self.space = spaces.Box(-FARTHEST, FARTHEST, (rows, cols, 3), np.float32)

    def look(self, cloths: Moving) -> np.ndarray:
        """Return the array of each cloth at this time, (n, rows, cols, 3)."""
        return np.nan_to_num(cloths.positions(), copy=False)


class PositionsAndVelocities(Part):
    """
    Positions [m] and velocities [m/s] of all nodes, (rows, cols, 6) float32.

    They are 0 where a shape has no node.
    """

    def __init__(self, rows: int, cols: int) -> None:
        """Make the space."""
        self.space = spaces.Box(-FARTHEST, FARTHEST, (rows, cols, 6), np.float32)

    def look(self, cloths: Moving) -> np.ndarray:
        """Return the array of each cloth at this time, (n, rows, cols, 6)."""
        return np.nan_to_num(np.concatenate(
            [cloths.positions(), cloths.velocities()], axis=-1), copy=False)


class Depth(Part):
    """
    A depth picture [m], (height, width) float32, its uppermost line first.

    :param task: says from where it is taken
    """

    def __init__(self, task: Observed) -> None:
        """Place the camera."""
        size = checked_size(task.picture_size)
        self._camera = camera_for(checked_angles(task.camera), task, size)
        self.space = spaces.Box(0.0, self._camera.model.far, size, np.float32)

    def look(self, cloths: Moving) -> np.ndarray:
        """Return the array of each cloth at this time, (n, height, width)."""
        pictures = [
            self._camera.capture(
                cloth, color=False, labels=False, normals=False, visible=False).depth
            for cloth in cloths.views()]
        # What is nearer than the camera measures is at it, and where nothing is, there is far.
        return np.clip(np.array(pictures), 0.0, np.float32(self._camera.model.far))

    def close(self) -> None:
        """Free its memory on the device."""
        self._camera.close()


class Own(Part):
    """
    What a function of the user's returns, as float32.

    :param function: gets positions and velocities of n cloths, and returns (n, ...) numbers
    :param at_start: these of some cloths, for the shape
    """

    def __init__(self, function: OwnFunction, at_start: tuple[np.ndarray, np.ndarray]) -> None:
        """Ask it once."""
        self._function = function
        shape = asked(function, 'observation', *at_start).shape[1:]
        most = np.finfo(np.float32).max
        self.space = spaces.Box(-most, most, shape, np.float32)

    def look(self, cloths: Moving) -> np.ndarray:
        """Return the array of each cloth at this time, (n, ...)."""
        return asked(
            self._function, 'observation', cloths.positions(), cloths.velocities(),
            self.space.shape).astype(np.float32)


_CHOOSE = 'choose one, or several for a dictionary'
PARTS = ('positions', 'state', 'depth')


class Observer:
    """
    Looks at cloths as the environment was asked to.

    :param task: says what to observe: one of PARTS for an array, several for a dictionary of
        arrays, or a function
    :raises ClothSimError: when a value is wrong
    """

    def __init__(self, task: Observed) -> None:
        """Make the parts and their space."""
        wanted = task.observation
        self._parts: dict[str, Part] = {}
        self._is_one = True
        if callable(wanted):
            function = checked_function(wanted, 'observation')
            self._parts['own'] = Own(function, task.at_start(2))
        else:
            self._is_one = isinstance(wanted, str)
            shape = task.scene.rows, task.scene.cols
            for name in _checked_names(wanted):
                if name == 'depth':
                    self._parts[name] = Depth(task)
                elif name == 'state':
                    self._parts[name] = PositionsAndVelocities(*shape)
                else:
                    self._parts[name] = Positions(*shape)
        self.space: spaces.Space[Any] = (
            next(iter(self._parts.values())).space if self._is_one else
            spaces.Dict({name: part.space for name, part in self._parts.items()}))

    def look(self, cloths: Moving) -> Observation:
        """Return the observations of all cloths at this time, (n, ...)."""
        seen = {name: part.look(cloths) for name, part in self._parts.items()}
        return next(iter(seen.values())) if self._is_one else seen

    def look_at_one(self, cloths: Moving) -> Observation:
        """Return the observation of the first cloth, without the axis of cloths."""
        seen = self.look(cloths)
        if isinstance(seen, np.ndarray):
            return seen[0]
        return {name: part[0] for name, part in seen.items()}

    def close(self) -> None:
        """Free its memory on the device."""
        for part in self._parts.values():
            part.close()


def _checked_names(asked: object) -> list[str]:
    names = [asked] if isinstance(asked, str) else iterable(asked, 'an observation', _CHOOSE)
    are_known = all(isinstance(name, str) and name in PARTS for name in names)
    if not names or not are_known or len(set(names)) < len(names):
        raise ClothSimError(
            f'an observation must be {", ".join(PARTS[:-1])} or {PARTS[-1]}, a list of them, or a '
            f'function, got {shown(asked)}: {_CHOOSE}')
    return names
