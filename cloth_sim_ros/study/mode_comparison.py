# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The speed of whole modes at equal stretch, in one run in which all have their turn."""

from collections.abc import Callable
from collections.abc import Iterable
from collections.abc import Mapping
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import asdict
from dataclasses import dataclass
import os
import platform
import statistics
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.recording.bag_metadata import project_version
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.growth import fit_growth
from cloth_sim_ros.study.growth import Growth
from cloth_sim_ros.study.mode_runs import BASELINE
from cloth_sim_ros.study.mode_runs import Contender
from cloth_sim_ros.study.mode_runs import FRAME
from cloth_sim_ros.study.mode_runs import LIGHT_CLOTH
from cloth_sim_ros.study.mode_runs import Stretch
from cloth_sim_ros.study.mode_runs import TimedRun
import numpy as np
import OpenGL

# Max. simulated time [s] and rounds [1] that are accepted; more is taken for a typing error.
_MOST_SECONDS = 3600.0
_MOST_ROUNDS = 1000


@dataclass(frozen=True, kw_only=True)
class ModeSpeed:
    """
    What one contender came to on one grid.

    Ratios are to the baseline on the same grid, None where that did not run or lost its state.
    All figures are None when the state was lost.

    :param grid: nodes along each side
    :param values: scene parameters besides those of the cloth
    :param real_time_factor: simulated over wall time, median of the rounds
    :param real_time_factors: of each round
    :param ratio: of real-time factors, median of the rounds
    :param ratios: of each round
    :param processor_ratio: the same of processor times, which a busy machine disturbs less;
        None on a GPU, too
    :param substep_rate: substeps in a simulated second [1/s]
    :param solve_rate: linear solves in a simulated second [1/s]
    :param iterations_per_solve: mean; None without a solver
    :param energy_rise: as in RunRecord, over M g L
    :param bound: on the stretch, in words
    :param is_within_bound: whether the stretch keeps to it
    :param failure: why the state was lost; None when it was not
    """

    contender: str
    grid: int
    values: Mapping[str, Any]
    real_time_factor: float | None = None
    real_time_factors: tuple[float, ...] = ()
    ratio: float | None = None
    ratios: tuple[float, ...] = ()
    processor_ratio: float | None = None
    stretch: Stretch | None = None
    substep_rate: float | None = None
    solve_rate: float | None = None
    iterations_per_solve: float | None = None
    energy_rise: float | None = None
    bound: str
    is_within_bound: bool
    failure: str | None = None


@dataclass(frozen=True, kw_only=True)
class ModeComparison:
    """
    All contenders on all grids.

    :param cloth: scene parameters that all have
    :param seconds: simulated in a round [s]
    :param frame: time between frames, and simulated in a turn [s]
    :param growth: of wall time with N, the nodes along a side; of contenders that finished on two
        grids at least
    :param versions: of what the figures depend on, by name
    :param worker_threads: of a software device, as LP_NUM_THREADS gives them
    """

    cloth: Mapping[str, Any]
    seconds: float
    frame: float
    rounds: int
    speeds: tuple[ModeSpeed, ...]
    growth: Mapping[str, Growth]
    device: str
    versions: Mapping[str, str]
    worker_threads: str

    def as_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return asdict(self)


def compare_modes(
        contenders: Sequence[Contender], grids: Sequence[int], *, seconds: float, rounds: int,
        progress: Callable[[range], Iterable[int]] = iter) -> ModeComparison:
    """
    Simulate the light cloth with all ``contenders`` on all ``grids``, a frame of each in turn.

    So what slows the machine down for a while, slows all of them down.

    :param grids: nodes along each side, 2 at least
    :param seconds: simulated in a round, rounded to whole frames [s]
    :param rounds: how often each run is made from the start
    :param progress: hands on the frames to come, which are numbered through all rounds
    :raises ClothSimError: when a value is wrong or a scene can't be run
    """
    _check(grids, seconds, rounds)
    frames = round(seconds / FRAME)
    with ExitStack() as stack:
        context = Context(single_thread=True)
        stack.callback(context.close)
        runs: list[TimedRun] = []
        for grid in grids:
            for contender in contenders:
                runs.append(TimedRun(contender, grid, context))
                stack.callback(runs[-1].close)
        for number in progress(range(rounds * frames)):
            # Each comes first in its turn.
            first = number % len(runs)
            for run in (*runs[first:], *runs[:first]):
                if number % frames == 0:
                    run.begin_round()
                run.make_frame()
        speeds = tuple(_speed(run, _baseline(run, runs), frames * FRAME, context.is_software)
                       for run in runs)
        return ModeComparison(
            cloth=dict(LIGHT_CLOTH), seconds=frames * FRAME, frame=FRAME, rounds=rounds,
            speeds=speeds, growth=growth_exponents(speeds), device=context.device,
            versions={
                'cloth_sim_ros': project_version(), 'OpenGL': context.version,
                'PyOpenGL': OpenGL.__version__, 'numpy': np.__version__,
                'python': platform.python_version()},
            worker_threads=os.environ.get('LP_NUM_THREADS', '0'))


def growth_exponents(speeds: Sequence[ModeSpeed]) -> dict[str, Growth]:
    """Return how wall time grows with N for each contender that finished on two grids at least."""
    growths = {}
    for name in dict.fromkeys(speed.contender for speed in speeds):
        finished = [
            (speed.grid, 1.0 / speed.real_time_factor) for speed in speeds
            if speed.contender == name and speed.real_time_factor is not None]
        growth = fit_growth(*zip(*finished)) if finished else None
        if growth is not None:
            growths[name] = growth
    return growths


def _check(grids: Sequence[int], seconds: float, rounds: int) -> None:
    for grid in grids:
        if grid < 2:
            raise ClothSimError(
                f'a grid has {grid} nodes along each side: give at least 2, or there is no edge')
    if not FRAME <= seconds <= _MOST_SECONDS:
        raise ClothSimError(
            f'a round cannot simulate {seconds:g} s: give {FRAME:g} to {_MOST_SECONDS:g} s')
    if not 1 <= rounds <= _MOST_ROUNDS:
        raise ClothSimError(f'there cannot be {rounds} rounds: give 1 to {_MOST_ROUNDS}')


def _baseline(run: TimedRun, runs: Sequence[TimedRun]) -> TimedRun | None:
    return next((
        other for other in runs if other.grid == run.grid and other.failure is None
        and other.contender.name == BASELINE), None)


def _speed(
        run: TimedRun, baseline: TimedRun | None, seconds: float, is_software: bool) -> ModeSpeed:
    contender = run.contender
    who: dict[str, Any] = {
        'contender': contender.name, 'grid': run.grid, 'values': dict(contender.values),
        'bound': str(contender.bound)}
    if run.failure is not None:
        return ModeSpeed(**who, is_within_bound=False, failure=run.failure)
    factors = tuple(seconds / wall for wall in run.wall_seconds)
    compared: dict[str, Any] = {}
    if baseline is not None:
        ratios = _ratios(baseline.wall_seconds, run.wall_seconds)
        compared = {'ratio': statistics.median(ratios), 'ratios': ratios}
        if is_software:
            compared['processor_ratio'] = statistics.median(
                _ratios(baseline.processor_seconds, run.processor_seconds))
    record, stretch = run.record, run.record.stretch
    return ModeSpeed(
        **who, **compared, real_time_factor=statistics.median(factors), real_time_factors=factors,
        stretch=stretch, is_within_bound=stretch.is_within(contender.bound),
        substep_rate=record.substep_rate, solve_rate=record.solve_rate,
        iterations_per_solve=record.iterations_per_solve, energy_rise=record.energy_rise)


def _ratios(others: Sequence[float], own: Sequence[float]) -> tuple[float, ...]:
    return tuple(other / time for other, time in zip(others, own))


# The comparison of modes as a table.

_HEAD = (
    '| N | | real-time factor | over mass_spring (rounds) | by processor time | peak stretch '
    '| 95th percentile: worst frame, all | substeps/s | solves/s | iterations a solve '
    '| energy rise / M g L | stretch within bound |',
    '|---|---|---|---|---|---|---|---|---|---|---|---|')


def comparison_table(comparison: ModeComparison) -> str:
    """Return the table in Markdown, with what was measured above and the growth below."""
    cloth = comparison.cloth
    lines = [
        f'{cloth["width"]:g} x {cloth["height"]:g} m, {cloth["areal_density"]:g} kg/m2, pins '
        f'{" ".join(cloth["pins"])}, {comparison.seconds:g} s from level, {comparison.rounds} '
        f'rounds, {1e3 * comparison.frame:g} ms of each in turn, on {comparison.device}',
        '', *_HEAD, *map(_row, comparison.speeds)]
    if comparison.growth:
        exponents = ', '.join(
            f'{name} {growth}' for name, growth in comparison.growth.items())
        lines += ['', f'Wall time grows with N to the power of: {exponents}']
    return '\n'.join(lines)


def _row(speed: ModeSpeed) -> str:
    if speed.failure is not None:
        return f'| {speed.grid} | {speed.contender} | {speed.failure} |' + 9 * ' |'
    stretch, rise = speed.stretch, speed.energy_rise
    assert stretch is not None and rise is not None  # it has no failure
    cells = [
        speed.grid, speed.contender, f'{speed.real_time_factor:.3g}', _ratio(speed),
        '-' if speed.processor_ratio is None else f'{speed.processor_ratio:.3g}',
        f'{100.0 * stretch.peak:.2f} %',
        f'{100.0 * stretch.worst_frame_percentile:.2f} %, {100.0 * stretch.percentile:.2f} %',
        f'{speed.substep_rate:.0f}', f'{speed.solve_rate:.0f}' if speed.solve_rate else '-',
        '-' if speed.iterations_per_solve is None else f'{speed.iterations_per_solve:.1f}',
        f'{100.0 * rise:.2f} %',
        f'{"yes" if speed.is_within_bound else "NO"} ({speed.bound})']
    return f'| {" | ".join(map(str, cells))} |'


def _ratio(speed: ModeSpeed) -> str:
    if speed.ratio is None:
        return '-'
    return f'{speed.ratio:.3g} ({min(speed.ratios):.3g} to {max(speed.ratios):.3g})'
