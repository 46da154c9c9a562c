# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Time all contenders on the paper's cloths, in turn, within a bound on the wall time."""

from collections.abc import Callable
from collections.abc import Sequence
from concurrent.futures import BrokenExecutor
from contextlib import ExitStack
from dataclasses import asdict
from dataclasses import dataclass
from dataclasses import field
import os
import statistics
import time
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.simulation import SINGLE_THREAD_NODES
from cloth_sim_ros.study.growth import fit_growth
from cloth_sim_ros.study.growth import Growth
from cloth_sim_ros.study.paper.cloths import PaperCloth
from cloth_sim_ros.study.paper.cloths import State
from cloth_sim_ros.study.paper.contenders import Contender
from cloth_sim_ros.study.paper.contenders import CONTENDERS
from cloth_sim_ros.study.paper.contenders import PaperConstraintCloth
from cloth_sim_ros.study.paper.contenders import Program
from cloth_sim_ros.study.paper.printed import PrintedSpeed
from cloth_sim_ros.study.paper.printed import TABLE
from cloth_sim_ros.study.paper.serial import CompiledCloth
from cloth_sim_ros.study.paper.serial_model import NumpyCloth
from cloth_sim_ros.study.workers import Workers

# Step time over the bound of a row [1] above which a program is timed once, not in rounds.
_LONG_STEP = 0.1


@dataclass(frozen=True)
class Speed:
    """
    Frames per second of one contender on one cloth.

    :param fps: median of the rounds; None when it was not run
    :param rounds: of each round; a single one where a step takes long
    :param ratios: to the serial program of the paper in each round
    :param plain_ratios: to the serial program without a matrix, where there is one, in each round
    :param detail: description of the program, or size of the system it solved
    :param reason: why it was not run
    """

    contender: str
    is_serial: bool
    fps: float | None = None
    rounds: tuple[float, ...] = ()
    ratios: tuple[float, ...] = ()
    plain_ratios: tuple[float, ...] = ()
    detail: str = ''
    reason: str = ''


@dataclass(frozen=True)
class TimedCloth:
    """
    All contenders on one cloth.

    :param families: as in PaperCloth
    :param printed: what the paper prints for it
    :param threads: of a software device, as LP_NUM_THREADS gives them; empty on a GPU
    """

    method: str
    nodes: int
    springs: int
    families: tuple[str, ...]
    printed: PrintedSpeed | None
    device: str
    threads: str
    speeds: tuple[Speed, ...]

    def as_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return asdict(self)


def time_alone(
        cloth: PaperCloth, *, rounds: int, turn_seconds: float,
        row_seconds: float) -> TimedCloth:
    """
    Return what ``time_cloth`` finds in a process of its own.

    A process keeps the worker threads that its first context was made with, and its end frees all
    memory of a large cloth.
    """
    try:
        with Workers(jobs=1).executor(1) as (executor, _):
            return executor.submit(
                time_cloth, cloth, rounds=rounds, turn_seconds=turn_seconds,
                row_seconds=row_seconds).result()
    except BrokenExecutor:
        return _not_run(cloth, '', '', 'its process was ended, as when memory runs out')


def time_cloth(
        cloth: PaperCloth, *, rounds: int, turn_seconds: float, row_seconds: float) -> TimedCloth:
    """
    Time the contenders on ``cloth`` in interleaved rounds, each from the same state.

    :param turn_seconds: wall time that a turn aims at [s]
    :param row_seconds: wall time of the rounds after which no other one begins [s]; a contender
        whose step is sure to take longer is not run; one that takes a tenth of it is timed once
    :raises DeviceError: when there is no device
    """
    single = cloth.nodes < SINGLE_THREAD_NODES
    with ExitStack() as stack:
        context = Context(single_thread=single)
        stack.callback(context.close)
        device = context.device
        threads = os.environ.get('LP_NUM_THREADS', '0' if single else 'default') if (
            context.is_software) else ''
        try:
            state = cloth.start(context)
        except (ClothSimError, DeviceError, MemoryError) as error:
            return _not_run(cloth, device, threads, _reason(error))
        runs = [_Run(each, cloth, context, row_seconds) for each in CONTENDERS[cloth.method]]
        for run in runs:
            stack.callback(run.close)
        for run in runs:
            run.start(state, turn_seconds)
        begin = time.perf_counter()
        in_rounds = [run for run in runs if run.is_quick]
        for _ in range(rounds):
            for run in in_rounds:
                run.take_turn(state)
            if time.perf_counter() - begin > row_seconds:
                break
        paper, plain = runs[0].figures, _without_matrix(runs)
        return _timed(cloth, device, threads, tuple(run.speed(paper, plain) for run in runs))


def growths(cloths: Sequence[TimedCloth]) -> dict[str, Growth]:
    """
    Return how the time of a frame grows with the nodes, of each contender and of the print.

    Cloths without bend edges have a growth of their own.
    """
    points: dict[str, list[tuple[float, float]]] = {}
    for cloth in cloths:
        printed = cloth.printed
        rates = {speed.contender: speed.fps for speed in cloth.speeds}
        if printed is not None and printed.source == TABLE:
            # Section 5 has limits, not measured rates.
            rates |= {'printed CPU': printed.cpu_fps, 'printed GPU': printed.gpu_fps}
        # The rates printed in the paper come first.
        for name, fps in sorted(rates.items(), key=lambda rate: 'printed' not in rate[0]):
            if fps:
                points.setdefault(name + without_bend(cloth), []).append((cloth.nodes, 1.0 / fps))
    fitted = {name: fit_growth(*zip(*found)) for name, found in points.items()}
    return {name: growth for name, growth in fitted.items() if growth is not None}


def without_bend(cloth: TimedCloth) -> str:
    """Return what is added to the names of programs on ``cloth``."""
    return '' if 'bend' in cloth.families else ', no bend edges'


class _Run:
    """One contender on one cloth; after ``open`` it has figures, or a reason for none."""

    def __init__(
            self, contender: Contender, cloth: PaperCloth, context: Context,
            bound: float) -> None:
        self.contender = contender
        self.figures: list[float] = []
        self.reason = ''
        self.is_quick = False
        self.close: Callable[[], None] = _nothing
        self._cloth = cloth
        self._context = context
        self._bound = bound
        self._detail = _Detail()

    def start(self, state: State, turn_seconds: float) -> None:
        """Compile, and time the first step, which gives the number of steps in a turn."""
        least = self.contender.least_seconds(self._cloth, self._context)
        if least > self._bound:
            self.reason = (
                f'the {self._cloth.springs:,} x {self._cloth.springs:,} pairs of constraints take '
                f'more than {least:.0f} s a step, and a row has {self._bound:g} s')
            return
        try:
            self._program = self.contender.start(self._cloth, state, self._context)
            self.close = self._program.close
            seconds = self._time(state, 1)
            self.is_quick = seconds < _LONG_STEP * self._bound
            if self.is_quick:
                # The first step has compiled what the device puts off until then.
                seconds = self._time(state, 1)
            else:
                self.figures.append(1.0 / seconds)
        except (ClothSimError, DeviceError, MemoryError) as error:
            self.reason = _reason(error)
            return
        self._count = max(round(turn_seconds / seconds), 1)

    def take_turn(self, state: State) -> None:
        """Time the steps of a turn."""
        self.figures.append(1.0 / self._time(state, self._count))

    def speed(self, paper: Sequence[float], plain: Sequence[float]) -> Speed:
        """Return the figures, and their ratios to those of the serial programs."""
        name, is_serial = self.contender.name, self.contender.is_serial
        if not self.figures:
            return Speed(name, is_serial, reason=self.reason)
        return Speed(
            name, is_serial, statistics.median(self.figures), tuple(self.figures),
            _ratios(self.figures, paper), _ratios(self.figures, plain), str(self._detail))

    def _time(self, state: State, count: int) -> float:
        """Return the mean wall time of ``count`` steps or some more, from ``state`` [s]."""
        program, seconds = self._program, 0.0
        steps = min(count, self._cloth.most_steps)
        passes = -(-count // steps)
        for _ in range(passes):
            program.set_state(*state)
            if self.is_quick:
                # One step restores the state that a mode keeps between steps.
                program.step()
            program.finish()
            begin = time.perf_counter()
            for _ in range(steps):
                program.step()
            program.finish()
            seconds += time.perf_counter() - begin
        self._detail.add(program)
        return seconds / (steps * passes)


@dataclass
class _Detail:
    """What the last steps of turns had to solve."""

    kind: str = ''
    held: list[int] = field(default_factory=list)
    iterations: list[int] = field(default_factory=list)

    def add(self, program: Program) -> None:
        if isinstance(program, (CompiledCloth, NumpyCloth)):
            self.kind = program.name
            self.held.append(program.held)
            self.iterations.append(program.iterations)
        elif isinstance(program, PaperConstraintCloth):
            self.iterations.append(program.iterations)

    def __str__(self) -> str:
        parts = [self.kind] if self.kind else []
        if any(self.held):
            parts.append(f'{statistics.median_high(self.held):,} constraints')
        if any(self.iterations):
            parts.append(f'{statistics.median_high(self.iterations)} iterations')
        return ', '.join(parts)


def _without_matrix(runs: Sequence[_Run]) -> Sequence[float]:
    """Return the figures of the serial program without a matrix, beside one that has it."""
    return next((run.figures for run in runs[1:] if run.contender.is_serial), ())


def _ratios(own: Sequence[float], others: Sequence[float]) -> tuple[float, ...]:
    """Return the ratios round by round; one of medians where either was timed just once."""
    if not others:
        return ()
    if len(own) == len(others):
        return tuple(fps / other for fps, other in zip(own, others))
    return (statistics.median(own) / statistics.median(others),)


def _not_run(cloth: PaperCloth, device: str, threads: str, reason: str) -> TimedCloth:
    return _timed(cloth, device, threads, tuple(
        Speed(each.name, each.is_serial, reason=reason) for each in CONTENDERS[cloth.method]))


def _timed(
        cloth: PaperCloth, device: str, threads: str, speeds: tuple[Speed, ...]) -> TimedCloth:
    return TimedCloth(
        cloth.method, cloth.nodes, cloth.springs, cloth.families, cloth.printed, device, threads,
        speeds)


def _reason(error: Exception) -> str:
    return str(error) or 'there is no memory for it'


def _nothing() -> None:
    pass
