# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Carry a cloth by its pins to a goal."""

from collections.abc import Mapping
from collections.abc import Sequence
from typing import Any

from cloth_sim_ros.gym.carry_task import CarryTask
from cloth_sim_ros.gym.carry_task import checked_seed
from cloth_sim_ros.gym.carry_task import Outcome
from cloth_sim_ros.gym.cloths import SingleCloth
from cloth_sim_ros.gym.observations import Observation
from cloth_sim_ros.gym.observations import Observer
from cloth_sim_ros.gym.pictures import Pictures
from cloth_sim_ros.gym.pictures import RGB_ARRAY
from cloth_sim_ros.sim.model.frame_paths import FramePath
from cloth_sim_ros.sim.scene import Scene
import gymnasium
from gymnasium import spaces
import numpy as np

_ONE = np.array([0])


class CarryCloth(gymnasium.Env[Observation, np.ndarray]):
    """
    An action moves every hand; the reward is higher the nearer the cloth is to its goal.

    An action is (hands, 3) from -1 to 1: along each axis, how fast a hand moves for a ``frame``,
    over ``speed``. Hands are the pins of the scene, row by row, unless ``hands`` are given.

    An observation is an array of float32: ``positions`` [m], (rows, cols, 3); ``state``, with
    velocities [m/s] too, (rows, cols, 6); or ``depth`` [m], (height, width), what a depth camera
    at a fixed place sees, with the high of the space where it sees nothing. A list of these names
    makes it a dictionary of such arrays; a function makes it what that returns.

    The reward is minus the mean distance of the nodes from where they would be if the start had
    been moved by ``goal`` [m], or what the function ``reward`` returns. The episode terminates
    once that distance is within ``tolerance``, and is truncated where the state is lost; ``info``
    has ``distance`` [m], ``time`` [s], ``max_strain`` and ``problem``, which is empty or says why
    the state was lost.

    ``reset(seed=...)`` puts free nodes off their places by up to ``jitter`` of the node spacing;
    the same seed gives the same bits on one device.

    :param scene: what is carried, a Scene or parameters by name; its pins are the hands
    :param render_mode: rgb_array for pictures by ``render``; None for none
    :param task: as in CarryTask: goal, frame, speed, jitter, tolerance, hands, start, reward,
        observation, camera, picture_size and render_size
    :raises ClothSimError: when the scene has no pin or a value is wrong
    """

    metadata: dict[str, Any] = {'render_modes': [RGB_ARRAY], 'render_fps': 20}

    def __init__(
            self, scene: Scene | Mapping[str, Any] | None = None, *,
            render_mode: str | None = None, **task: Any) -> None:
        """Make the simulation and the spaces."""
        self._task = CarryTask(scene, **task)
        self._observer = Observer(self._task)
        self._pictures = Pictures(self._task, render_mode)
        self.render_mode = self._pictures.mode
        self._cloths = SingleCloth(self._task)
        # The node of each hand, of which it may hold more.
        self.pins = np.array([nodes[0] for nodes in self._task.hands])
        self.metadata = {**self.metadata, 'render_fps': self._task.frames_per_second}
        self.action_space = spaces.Box(-1.0, 1.0, (len(self._task.hands), 3), np.float32)
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
        super().reset(seed=checked_seed(seed))
        self._cloths.begin(_ONE, self._task.drawn_start(self.np_random)[None])
        return self._look(), self._info(self._outcome())

    def step(
            self, action: np.ndarray) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """
        Move the hands for a frame.

        :param action: (hands, 3) from -1 to 1
        :return: observation, reward, terminated, truncated and info
        :raises ClothSimError: when the action has another shape or a value outside its range
        """
        ways = self._task.checked_actions(action)
        (problem,) = self._cloths.play(self._task.moves(ways, self._cloths.positions()))
        outcome = self._outcome()
        return (
            self._look(), float(outcome.rewards[0]), bool(outcome.arrived[0]), bool(problem),
            self._info(outcome, problem))

    def move_collider(
            self, name: str, target: Sequence[float], orientation: Sequence[float] | None = None,
            speed: float | None = None, angular_speed: float | None = None, *,
            duration: float = 0.0) -> FramePath:
        """Move a collider as ``Simulation.move_collider`` does; ``reset`` puts it back."""
        return self._cloths.simulation.move_collider(
            name, target, orientation, speed, angular_speed, duration=duration)

    def render(self) -> np.ndarray:
        """Return a picture, (height, width, 3) uint8; ClothSimError without a render_mode."""
        return self._pictures.take(self._cloths)[0]

    def close(self) -> None:
        """Release the device."""
        self._cloths.close()
        self._observer.close()
        self._pictures.close()

    def _look(self) -> Observation:
        return self._observer.look_at_one(self._cloths)

    def _outcome(self) -> Outcome:
        return self._task.outcome(self._cloths.positions(), self._cloths.velocities())

    def _info(self, outcome: Outcome, problem: str = '') -> dict[str, Any]:
        info: dict[str, Any] = {
            'time': float(self._cloths.times()[0]),
            'max_strain': float(self._cloths.strains()[0]), 'problem': problem}
        if outcome.distances is not None:
            info['distance'] = float(outcome.distances[0])
        return info
