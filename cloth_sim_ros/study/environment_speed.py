# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How fast environments of gymnasium step: many together, and one by one, in turns."""

from dataclasses import asdict
from dataclasses import dataclass
import statistics
from time import process_time
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gym import CarryCloth
from cloth_sim_ros.gym import make_vec
from gymnasium.vector import SyncVectorEnv
from gymnasium.vector import VectorEnv
import numpy as np


@dataclass(frozen=True)
class EnvironmentSpeed:
    """
    Steps of environments.

    :param nodes: of each cloth, along each side
    :param count: of environments
    :param together: steps per second of processor time with make_vec, by round [1/s]
    :param one_by_one: the same with gymnasium's SyncVectorEnv [1/s]
    """

    nodes: int
    count: int
    device: str
    together: list[float]
    one_by_one: list[float]

    @property
    def ratios(self) -> list[float]:
        """Return how many times as fast they are together, round by round."""
        return [batch / alone for batch, alone in zip(self.together, self.one_by_one)]

    def as_dict(self) -> dict[str, Any]:
        """Return it for JSON."""
        return {**asdict(self), 'ratios': self.ratios}

    def in_words(self) -> str:
        """Return a line for people."""
        return (
            f'{self.count} environments of {self.nodes} x {self.nodes} nodes: together '
            f'{statistics.median(self.together):.0f} steps/s, one by one '
            f'{statistics.median(self.one_by_one):.0f}, {statistics.median(self.ratios):.2f} x '
            f'({min(self.ratios):.2f} to {max(self.ratios):.2f})')


def measure_environments(nodes: int, count: int, rounds: int) -> EnvironmentSpeed:
    """Step ``count`` environments both ways, with the same random actions, in turns."""
    scene = {
        'rows': nodes, 'cols': nodes, 'width': 0.4, 'height': 0.4, 'start.pose': 'hanging'}
    made: tuple[VectorEnv[Any, Any, Any], ...] = (
        make_vec(count, scene, max_steps=None),
        SyncVectorEnv([lambda: CarryCloth(scene)] * count))
    speeds: tuple[list[float], list[float]] = ([], [])
    random = np.random.default_rng(1)
    for environments in made:
        environments.reset(seed=1)
    # A first round compiles.
    for number in range(rounds + 1):
        actions = random.uniform(-1.0, 1.0, made[0].action_space.shape).astype(np.float32)
        for environments, measured in zip(made, speeds):
            begin = process_time()
            environments.step(actions)
            if number:
                measured.append(count / (process_time() - begin))
    for environments in made:
        environments.close()
    context = Context(single_thread=True)
    device = context.device
    context.close()
    return EnvironmentSpeed(nodes, count, device, *speeds)
