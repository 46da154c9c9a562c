# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Carry a cloth by its pins to a goal."""

from collections.abc import Mapping
from collections.abc import Sequence
from types import MappingProxyType
from typing import Any

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.gym.observations import Observation
from cloth_sim_ros.gym.observations import Observer
from cloth_sim_ros.sim.arguments import array
from cloth_sim_ros.sim.arguments import integer
from cloth_sim_ros.sim.arguments import real_number
from cloth_sim_ros.sim.arguments import vector_or_none
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.model.pins import FARTHEST
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import gymnasium
from gymnasium import spaces
import numpy as np

_DEFAULT = {'rows': 16, 'cols': 16, 'width': 0.4, 'height': 0.4, 'start.pose': 'hanging'}
_NOTHING = 1e-9  # [m]
_LONGEST_FRAME = 1e6  # [s]; chosen: eleven days of simulated time are no action
_FASTEST = 1e6  # [m/s]; as of any pin, sim/model/pins.py


class CarryCloth(gymnasium.Env[Observation, np.ndarray]):
    """
    An action moves every pin; the reward is higher the nearer the cloth is to its goal.

    An action is (pins, 3) from -1 to 1: along each axis, how fast a pin moves for a ``frame``,
    over ``speed``. Pins are in the order of ``pins``, row by row.

    An observation is an array of float32: ``positions`` [m], (rows, cols, 3); ``state``, with
    velocities [m/s] too, (rows, cols, 6); or ``depth`` [m], (height, width), what a depth camera
    at a fixed place sees, with the high of the space where it sees nothing. A list of these names
    makes it a dictionary of such arrays.

    The reward is minus the mean distance of the nodes from where they would be if the start pose
    had been moved by ``goal`` [m]. The episode terminates once that is within ``tolerance``, and
    is truncated where the state is lost; ``info`` has ``distance`` [m], ``time`` [s],
    ``max_strain`` and ``problem``, which is empty or says why the state was lost.

    ``reset(seed=...)`` puts free nodes off their places by up to ``jitter`` of the node spacing;
    the same seed gives the same bits on one device.

    :param scene: what is carried, a Scene or parameters by name; its pins are the hands
    :param goal: x y z [m], from the start
    :param frame: simulated time of an action [s], rounded to whole steps of dt
    :param speed: of a pin along each axis at an action of 1 [m/s]
    :param observation: positions, state or depth, or a list of them
    :param jitter: 0 to 0.5
    :param tolerance: mean distance that counts as there [m]
    :param camera: azimuth, elevation and field_of_view [deg], zoom and target [m] of the depth
        camera, by name; at zoom 1 it sees the whole cloth at its start and at its goal
    :param picture_size: height and width of the depth picture [pixel]
    :raises ClothSimError: when the scene has no pin or a value is wrong
    """

    metadata: dict[str, Any] = {'render_modes': []}

    def __init__(
            self, scene: Scene | Mapping[str, Any] | None = None, *,
            goal: Sequence[float] = (0.2, 0.0, 0.1), frame: float = 0.05, speed: float = 0.5,
            observation: str | Sequence[str] = 'positions', jitter: float = 0.01,
            tolerance: float = 0.02, camera: Mapping[str, Any] = MappingProxyType({}),
            picture_size: Sequence[int] = (64, 64)) -> None:
        """Make the simulation and the spaces."""
        if not isinstance(scene, Scene):
            scene = Scene(_DEFAULT if scene is None else scene)
        self.pins = np.argwhere(scene.pinned_nodes())
        if not len(self.pins):
            raise ClothSimError('the cloth is carried by its pins, but this scene has none: set '
                                'pins')
        frame = _checked('frame', frame, _LONGEST_FRAME, 's')
        speed = _checked('speed', speed, _FASTEST, 'm/s')
        tolerance = real_number(tolerance, 'the tolerance', 'give a distance in metres')
        if not 0.0 <= tolerance <= FARTHEST:
            raise ClothSimError(
                f'the tolerance must be from 0 to {FARTHEST:g} m, got {tolerance}: give a '
                'distance')
        jitter = real_number(jitter, 'the jitter', 'give a share of the node spacing')
        if not 0.0 <= jitter <= 0.5:
            raise ClothSimError(
                f'the jitter must be from 0 to 0.5 of the node spacing, got {jitter}: give less')
        offset = vector_or_none(goal)
        if offset is None or not all(abs(part) <= FARTHEST for part in offset):
            raise ClothSimError(
                f'the goal needs 3 numbers up to {FARTHEST:g} m, got {shown(goal)}: give x, y '
                'and z')
        start = scene.rest_positions()
        self._goal = start + np.array(offset)
        self._observer = Observer(
            observation, start.shape[:2], np.concatenate([start, self._goal]).reshape(-1, 3),
            camera, picture_size)
        self._simulation = Simulation(scene, records_forces=False)
        self._steps = max(round(frame / scene['dt']), 1)
        self._reach = speed * self._steps * scene['dt']
        self._jitter = jitter * min(length for length in scene.spacing if length > 0.0)
        self._tolerance = tolerance
        self._free = ~scene.pinned_nodes()
        self._present = scene.present_nodes
        self.action_space = spaces.Box(-1.0, 1.0, (len(self.pins), 3), np.float32)
        self.observation_space = self._observer.space

    def reset(
            self, *, seed: int | None = None,
            options: dict[str, Any] | None = None) -> tuple[Observation, dict[str, Any]]:
        """
        Put the cloth back to its start.

        :param seed: of the offsets; None continues the random numbers of the last seed
        :param options: none are known
        :return: observation and info
        """
        if seed is not None:
            seed = integer(seed, 'the seed', 'give an int of 0 or more, or None')
            if seed < 0:
                raise ClothSimError(f'the seed must be 0 or more, got {shown(seed)}: give another')
        super().reset(seed=seed)
        simulation = self._simulation
        simulation.reset()
        positions = simulation.scene.rest_positions()
        offsets = self.np_random.uniform(-self._jitter, self._jitter, positions.shape)
        positions += np.where(self._free[..., None], offsets, 0.0)
        simulation.set_state(positions, np.zeros_like(positions))
        return self._look(), self._info()

    def step(
            self, action: np.ndarray) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """
        Move the pins for a frame.

        :param action: (pins, 3) from -1 to 1
        :return: observation, reward, terminated, truncated and info
        :raises ClothSimError: when the action has another shape or a value outside its range
        """
        shape = (len(self.pins), 3)
        ways = array(action, 'an action', shape, 'give x, y and z from -1 to 1 for each pin')
        # NaN fails this as well.
        if not np.all(np.abs(ways.astype(np.float32)) <= 1.0):
            raise ClothSimError(
                f'an action must be {shape} numbers from -1 to 1, got {ways.min():g} to '
                f'{ways.max():g}: clip it')
        simulation = self._simulation
        places = simulation.positions()
        seconds = self._steps * simulation.dt
        for (row, col), way in zip(self.pins.tolist(), self._reach * ways):
            length = float(np.linalg.norm(way))
            if length > _NOTHING:
                simulation.move_pin(row, col, places[row, col] + way, speed=length / seconds)
        problem = ''
        try:
            simulation.step(self._steps)
        except NonFiniteStateError as error:
            problem = str(error)
        info = self._info(problem)
        return (
            self._look(), -info['distance'], info['distance'] <= self._tolerance, bool(problem),
            info)

    def close(self) -> None:
        """Release the device."""
        self._simulation.close()
        self._observer.close()

    def _look(self) -> Observation:
        return self._observer.look(self._simulation)

    def _info(self, problem: str = '') -> dict[str, Any]:
        away = self._simulation.positions() - self._goal
        return {
            'distance': float(np.linalg.norm(away[self._present], axis=-1).mean()),
            'time': self._simulation.time,
            'max_strain': self._simulation.measure().max_strain,
            'problem': problem,
        }


def _checked(name: str, value: float, most: float, unit: str) -> float:
    value = real_number(value, f'the {name}', f'give it in {unit}')
    if not 0.0 < value <= most:
        raise ClothSimError(
            f'the {name} must be above 0 {unit} and at most {most:g} {unit}, got {value}: give '
            f'{"less" if value > most else "more"}')
    return value
