# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which loads and block step a cloth fastest on this device, against those that are built in."""

from collections.abc import Iterator
from collections.abc import Mapping
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from dataclasses import field
from itertools import product
import statistics
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.sim.device.layout import choose_layout
from cloth_sim_ros.sim.device.tuning import BUILT_IN
from cloth_sim_ros.sim.device.tuning import Choice
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.speed import bench_scene
from cloth_sim_ros.study.speed import steps_for
from cloth_sim_ros.study.speed import time_steps
from cloth_sim_ros.study.speed import Timer

# Nodes along each side. Small cloths, of which there are many kinds, stand close together.
SIZES = (16, 32, 64, 256, 1024)
ROUNDS = 5
# In no round and with no cloth may a rival be less than this times as fast.
LEAST_GAIN = 1.03
_CANDIDATES = tuple(Choice(loads, block) for loads, block in product(
    ('texture', 'storage'), (1, 2, 4)))
# Repetitions per turn [1] and wall time of each [s]. The fastest counts: other programs slow some
# of them down.
_TRIES = 3
_TRY = 0.015
# Springs alone, and the fabric that a scene has by default. A rival has to win with both: their
# shaders need unlike numbers of registers.
_CLOTHS: tuple[Mapping[str, Any], ...] = ({}, {'material.preset': 'trousers'})


@dataclass
class Rival:
    """
    A choice that was measured against the built-in one.

    :param ratios: of its speed to that of the built-in one, of each round that it took part in
    :param is_out: whether it was too slow in one, and took part in no more
    """

    choice: Choice
    ratios: list[float] = field(default_factory=list)
    is_out: bool = False

    def in_words(self) -> str:
        """Return a line for people."""
        count = len(self.ratios)
        if self.is_out:
            return f'{self.choice!s:24}{self.ratios[-1]:5.2f} x in round {count}: out'
        return (
            f'{self.choice!s:24}{statistics.median(self.ratios):5.2f} x ({min(self.ratios):.2f} '
            f'to {max(self.ratios):.2f} in {count} rounds)')


@dataclass(frozen=True)
class TunedSize:
    """
    What was found for a square cloth.

    :param side: nodes along each side
    :param built_in: the choice for this device without a tuning
    """

    side: int
    built_in: Choice
    rivals: tuple[Rival, ...]

    @property
    def choice(self) -> Choice:
        """Return what is to be used: a rival that won in every round, or BUILT_IN."""
        winners = [rival for rival in self.rivals if rival.ratios and not rival.is_out]
        if not winners:
            return BUILT_IN
        return max(winners, key=lambda rival: min(rival.ratios)).choice

    def as_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            'rows': self.side, 'cols': self.side, 'built_in': vars(self.built_in),
            'choice': vars(self.choice),
            'rivals': [{**vars(rival.choice), 'ratios': rival.ratios} for rival in self.rivals]}

    def in_words(self) -> str:
        """Return lines for people."""
        chosen = 'kept' if self.choice == BUILT_IN else f'replaced by {self.choice}'
        return '\n'.join((
            f'{self.side} x {self.side}: built-in {self.built_in}, {chosen}',
            *(f'  {rival.in_words()}' for rival in self.rivals)))


def tune(
        context: Context, sizes: Sequence[int] = SIZES, rounds: int = ROUNDS,
        timer: Timer = time_steps) -> Iterator[TunedSize]:
    """
    Measure all choices at each of ``sizes``, in interleaved rounds, and yield what was found.

    A variant is dropped once it loses a round, so that most are measured once.
    """
    for side in sizes:
        yield _tune_size(context, side, rounds, timer)


def _tune_size(context: Context, side: int, rounds: int, timer: Timer) -> TunedSize:
    built_in = choose_layout(bench_scene(side, {}), context, tuned=False).choice
    rivals = tuple(
        Rival(choice) for choice in _CANDIDATES
        if choice != built_in and _fits(side, choice, context))
    for values in _CLOTHS:
        _measure(
            context, side, values, built_in, [rival for rival in rivals if not rival.is_out],
            rounds, timer)
    return TunedSize(side, built_in, rivals)


def _measure(
        context: Context, side: int, values: Mapping[str, Any], built_in: Choice,
        rivals: Sequence[Rival], rounds: int, timer: Timer) -> None:
    if not rivals:
        return
    with ExitStack() as stack:
        def made(choice: Choice) -> tuple[Simulation, int]:
            run = stack.enter_context(Simulation(
                bench_scene(side, {**values, **vars(choice)}), context=context))
            return run, steps_for(run, _TRY, timer)

        baseline = made(built_in)
        runs = [(rival, made(rival.choice)) for rival in rivals]
        for _ in range(rounds):
            speed = _speed(*baseline, timer)
            for rival, run in runs:
                if not rival.is_out:
                    rival.ratios.append(_speed(*run, timer) / speed)
                    rival.is_out = rival.ratios[-1] < LEAST_GAIN


def _speed(run: Simulation, steps: int, timer: Timer) -> float:
    return steps / min(timer(run, steps) for _ in range(_TRIES))


def _fits(side: int, choice: Choice, context: Context) -> bool:
    try:
        choose_layout(bench_scene(side, vars(choice)), context, tuned=False)
    except DeviceError:
        return False
    return True
