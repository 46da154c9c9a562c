# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How fast many small cloths step in a Batch, beside one Simulation after the other."""

from collections.abc import Callable
from dataclasses import asdict
from dataclasses import dataclass
import multiprocessing
import statistics
import time
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.batch import Batch
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.speed import bench_scene
import numpy as np

# A control step, as a policy makes them: a pin begins to move, then these steps, then a look.
_STEPS = 10
_WAY = np.array([0.0, 0.0, 1e-3])
_SPEED = 0.5


@dataclass(frozen=True)
class BatchSpeed:
    """
    Wall times of the same steps.

    :param frames: of each cloth, of ``steps`` steps each
    :param is_controlled: whether a pin moves and positions are read in each frame
    :param together: wall time in a batch, by round [s]
    :param one_by_one: of one simulation after the other, without making them [s]
    """

    size: int
    cloths: int
    frames: int
    steps: int
    is_controlled: bool
    device: str
    together: list[float]
    one_by_one: list[float]

    @property
    def ratios(self) -> list[float]:
        """Return how many times as fast the batch is in each round."""
        return [alone / batch for alone, batch in zip(self.one_by_one, self.together)]

    def as_dict(self) -> dict[str, Any]:
        """Return it for JSON."""
        return {**asdict(self), 'ratios': self.ratios}

    def in_words(self) -> str:
        """Return a line for people."""
        node_steps = self.cloths * self.size**2 * self.frames * self.steps
        kind = 'pin moved, positions read' if self.is_controlled else 'steps alone'
        return (
            f'{self.cloths} x ({self.size} x {self.size}), {kind}: together '
            f'{node_steps / statistics.median(self.together) / 1e6:.1f} million node steps/s, one '
            f'by one {node_steps / statistics.median(self.one_by_one) / 1e6:.1f}, '
            f'{statistics.median(self.ratios):.2f} x ({min(self.ratios):.2f} to '
            f'{max(self.ratios):.2f})')


def measure_batch(
        size: int, cloths: int, *, is_controlled: bool, frames: int, rounds: int) -> BatchSpeed:
    """
    Run ``cloths`` of ``size`` x ``size`` nodes both ways, interleaved.

    Each turn is a process of its own: a software device has threads for the batch alone, which is
    faster for both.
    """
    times: dict[Callable[..., tuple[str, float]], list[float]] = {_together: [], _one_by_one: []}
    device = ''
    with multiprocessing.get_context('spawn').Pool(1, maxtasksperchild=1) as pool:
        for _ in range(rounds):
            for way, measured in times.items():
                device, seconds = pool.apply(way, (size, cloths, frames, is_controlled))
                measured.append(seconds)
    return BatchSpeed(
        size, cloths, frames, _STEPS, is_controlled, device, times[_together],
        times[_one_by_one])


def _scenes(size: int, cloths: int) -> list[Scene]:
    values = bench_scene(size, {}).values
    return [Scene({**values, 'start.seed': number}) for number in range(cloths)]


def _together(size: int, cloths: int, frames: int, is_controlled: bool) -> tuple[str, float]:
    numbers, corner = np.arange(cloths), np.zeros((cloths, 2), dtype=int)
    with Batch(_scenes(size, cloths)) as batch:
        def move(places: np.ndarray) -> None:
            batch.move_pins(numbers, corner, places[:, 0, 0] + _WAY, _SPEED)
        return batch.device, _seconds(batch, move if is_controlled else None, frames)


def _one_by_one(size: int, cloths: int, frames: int, is_controlled: bool) -> tuple[str, float]:
    context = Context(single_thread=True)
    seconds = 0.0
    for scene in _scenes(size, cloths):
        with Simulation(scene, context=context) as simulation:
            def move(places: np.ndarray) -> None:
                simulation.move_pin(0, 0, places[0, 0] + _WAY, speed=_SPEED)
            seconds += _seconds(simulation, move if is_controlled else None, frames)
    return context.device, seconds


def _seconds(
        cloths: Batch | Simulation, move: Callable[[np.ndarray], None] | None,
        frames: int) -> float:
    """Return the wall time of ``frames`` [s], with a ``move`` from the last positions in each."""
    cloths.step(_STEPS)
    cloths.finish()
    places = cloths.positions()
    begin = time.perf_counter()
    for _ in range(frames):
        if move:
            move(places)
        cloths.step(_STEPS)
        if move:
            places = cloths.positions()
    cloths.finish()
    return time.perf_counter() - begin
