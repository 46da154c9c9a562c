# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Many environments of one task, whose cloths step together."""

from collections.abc import Mapping
from typing import Any

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.gym.carry_task import CarryTask
from cloth_sim_ros.gym.carry_task import checked_seed
from cloth_sim_ros.gym.carry_task import Outcome
from cloth_sim_ros.gym.cloths import BatchedCloths
from cloth_sim_ros.gym.observations import Observation
from cloth_sim_ros.gym.observations import Observer
from cloth_sim_ros.gym.pictures import Pictures
from cloth_sim_ros.gym.pictures import RGB_ARRAY
from cloth_sim_ros.sim.arguments import booleans
from cloth_sim_ros.sim.arguments import integer
from cloth_sim_ros.sim.arguments import iterable
from cloth_sim_ros.sim.arguments import mapping
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.frame_paths import FramePath
from cloth_sim_ros.sim.scene import Scene
from gymnasium import spaces
from gymnasium.utils.seeding import np_random
from gymnasium.vector import AutoresetMode
from gymnasium.vector import VectorEnv
from gymnasium.vector.utils import batch_space
import numpy as np

MAX_STEPS = 200  # [1]; chosen: 10 s of the default frame


class CarryCloths(VectorEnv[Observation, np.ndarray, np.ndarray]):
    """
    ``num_envs`` times CarryCloth, with the same numbers, whose cloths step in one dispatch.

    Actions are (num_envs, hands, 3), observations have an axis of cloths in front; rewards,
    terminations and truncations are (num_envs,). ``infos`` has arrays (num_envs,): ``distance``
    [m], ``time`` of the episode [s], ``max_strain`` and ``problem``, and for each a mask, such as
    ``_distance``, which is True throughout.

    An episode is truncated after ``max_steps`` actions, or where its state is lost. Then the next
    call of ``step`` leaves out the action for that cloth, and begins its next episode, as
    gymnasium's AutoresetMode.NEXT_STEP says: reward 0, and the first observation.

    ``reset(seed=s)`` gives cloth i the seed s + i; later episodes continue its random numbers.

    :param num_envs: how many cloths
    :param scene: as of CarryCloth; what a Batch lacks is refused
    :param max_steps: actions of an episode; None for no limit
    :param render_mode: rgb_array for pictures by ``render``; None for none
    :param task: as in CarryTask: goal, frame, speed, jitter, tolerance, hands, start, reward,
        observation, camera, picture_size and render_size
    :raises ClothSimError: when a Batch can't step the scene, or a value is wrong
    """

    metadata: dict[str, Any] = {
        'render_modes': [RGB_ARRAY], 'render_fps': 20, 'autoreset_mode': AutoresetMode.NEXT_STEP}

    def __init__(
            self, num_envs: int, scene: Scene | Mapping[str, Any] | None = None, *,
            max_steps: int | None = MAX_STEPS, render_mode: str | None = None,
            **task: Any) -> None:
        """Make the batch and the spaces."""
        self.num_envs = _checked_count(num_envs, 'num_envs', 'environments')
        self._max_steps = (
            np.inf if max_steps is None else _checked_count(max_steps, 'max_steps', 'actions'))
        self._task = CarryTask(scene, **task)
        self._observer = Observer(self._task)
        self._pictures = Pictures(self._task, render_mode)
        self.render_mode = self._pictures.mode
        self._cloths = BatchedCloths(self._task, self.num_envs)
        self.metadata = {**self.metadata, 'render_fps': self._task.frames_per_second}
        self.single_action_space = spaces.Box(
            -1.0, 1.0, (len(self._task.hands), 3), np.float32)
        self.single_observation_space = self._observer.space
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self._randoms, self._seeds = map(list, zip(*(np_random() for _ in range(self.num_envs))))
        # Actions of each episode, and which of them has ended.
        self._made = np.zeros(self.num_envs, dtype=int)
        self._is_over = np.zeros(self.num_envs, dtype=bool)

    @property
    def np_random_seed(self) -> tuple[int, ...]:  # type: ignore[override]
        """Return the seed that each of them began with."""
        return tuple(self._seeds)

    def reset(
            self, *, seed: int | list[int | None] | None = None,
            options: dict[str, Any] | None = None) -> tuple[Observation, dict[str, Any]]:
        """
        Put the cloths back to their starts.

        :param seed: of the offsets, of the first cloth, the next has the next one; or a list with
            one for each; None continues the random numbers of the last ones
        :param options: ``reset_mask``, (num_envs,) bool, says which; the others go on
        :return: observations and infos
        """
        seeds = self._checked_seeds(seed)
        mask = np.ones(self.num_envs, dtype=bool)
        if options is not None:
            given = mapping(options, 'the options', "give {'reset_mask': mask}, or None")
            if given.get('reset_mask') is not None:
                mask = booleans(given['reset_mask'], 'the reset_mask', (self.num_envs,))
        for number in np.flatnonzero(mask).tolist():
            if seeds[number] is not None:
                self._randoms[number], self._seeds[number] = np_random(seeds[number])
        self._begin(mask)
        return self._observer.look(self._cloths), self._infos(
            self._outcome(), [''] * self.num_envs)

    def step(self, actions: np.ndarray) -> tuple[
            Observation, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """
        Move the hands for a frame, or begin anew where the episode has ended.

        :param actions: (num_envs, hands, 3) from -1 to 1
        :return: observations, rewards, terminations, truncations and infos
        :raises ClothSimError: when they have another shape or a value outside its range; then
            nothing is changed
        """
        ways = self._task.checked_actions(actions, self.num_envs)
        is_new = self._is_over
        ways[is_new] = 0.0
        problems = self._cloths.play(self._task.moves(ways, self._cloths.positions()))
        self._made += 1
        self._begin(is_new)
        problems = ['' if new else problem for new, problem in zip(is_new, problems)]
        outcome = self._outcome()
        rewards = np.where(is_new, 0.0, outcome.rewards)
        terminations = outcome.arrived & ~is_new
        truncations = np.array([bool(problem) for problem in problems]) | (
            self._made >= self._max_steps)
        self._is_over = terminations | truncations
        return (
            self._observer.look(self._cloths), rewards, terminations, truncations,
            self._infos(outcome, problems))

    def move_collider(
            self, cloths: np.ndarray, name: str, targets: np.ndarray,
            orientations: np.ndarray | None = None, speeds: np.ndarray | float | None = None,
            angular_speeds: np.ndarray | float | None = None, *,
            durations: np.ndarray | float = 0.0) -> tuple[FramePath, ...]:
        """
        Move a collider of some cloths as ``Batch.move_collider`` does.

        The next episode of a cloth begins with its collider where the scene has it.
        """
        return self._cloths.batch.move_collider(
            cloths, name, targets, orientations, speeds, angular_speeds, durations=durations)

    def render(self) -> tuple[np.ndarray, ...]:
        """Return pictures, (height, width, 3) uint8; ClothSimError without a render_mode."""
        return self._pictures.take(self._cloths)

    def close_extras(self, **kwargs: Any) -> None:
        """Release the device."""
        self._cloths.close()
        self._observer.close()
        self._pictures.close()

    def _begin(self, mask: np.ndarray) -> None:
        """Begin the next episode of some cloths."""
        numbers = np.flatnonzero(mask)
        if len(numbers):
            self._cloths.begin(numbers, np.array([
                self._task.drawn_start(self._randoms[number]) for number in numbers]))
        self._made[numbers] = 0
        self._is_over = self._is_over & ~mask

    def _outcome(self) -> Outcome:
        return self._task.outcome(self._cloths.positions(), self._cloths.velocities())

    def _infos(self, outcome: Outcome, problems: list[str]) -> dict[str, Any]:
        infos: dict[str, Any] = {
            'time': self._cloths.times(), 'max_strain': self._cloths.strains(),
            'problem': np.array(problems, dtype=object)}
        if outcome.distances is not None:
            infos['distance'] = outcome.distances
        masks = {f'_{name}': np.ones(self.num_envs, dtype=bool) for name in infos}
        return {**infos, **masks}

    def _checked_seeds(self, seed: int | list[int | None] | None) -> list[int | None]:
        if seed is None:
            return [None] * self.num_envs
        if isinstance(seed, (list, tuple, np.ndarray)):
            seeds = iterable(seed, 'the seeds', 'give one for each cloth')
            if len(seeds) != self.num_envs:
                raise ClothSimError(
                    f'{self.num_envs} cloths need as many seeds, got {len(seeds)}: give one for '
                    'each, or one int')
            return [checked_seed(each) for each in seeds]
        first = checked_seed(seed)
        assert first is not None
        return [first + number for number in range(self.num_envs)]


def make_vec(
        num_envs: int, scene: Scene | Mapping[str, Any] | None = None, *,
        max_steps: int | None = MAX_STEPS, render_mode: str | None = None,
        **task: Any) -> CarryCloths:
    """
    Return ``num_envs`` environments of one task, whose cloths step in one dispatch.

    :param num_envs: how many cloths
    :param scene: what is carried, a Scene or parameters by name
    :param max_steps: actions of an episode; None for no limit
    :param render_mode: rgb_array for pictures by ``render``; None for none
    :param task: as in CarryTask: goal, frame, speed, jitter, tolerance, hands, start, reward,
        observation, camera, picture_size and render_size
    :raises ClothSimError: when a Batch can't step the scene, or a value is wrong
    """
    return CarryCloths(num_envs, scene, max_steps=max_steps, render_mode=render_mode, **task)


def made_by_name(
        num_envs: int, max_episode_steps: int | None = None, **options: Any) -> CarryCloths:
    """Return what `gymnasium.make_vec` makes: it has a name of its own for ``max_steps``."""
    return CarryCloths(num_envs, max_steps=max_episode_steps, **options)


def _checked_count(value: int, name: str, of: str) -> int:
    count = integer(value, name, f'give the number of {of}')
    if count < 1:
        raise ClothSimError(f'{name} must be 1 or more, got {shown(count)}: give more {of}')
    return count
