# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Make the runs of a study that are not there yet, and keep each as it ends."""

from collections.abc import Generator
from collections.abc import Iterable
from collections.abc import Iterator
from collections.abc import Sequence
from concurrent.futures import BrokenExecutor
from concurrent.futures import Executor
from concurrent.futures import FIRST_COMPLETED
from concurrent.futures import Future
from concurrent.futures import wait
from contextlib import closing
from importlib import import_module
from itertools import islice
import os
import sys
import time
from typing import Any

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.model.scene_fields import SCENE_FIELDS
from cloth_sim_ros.study.results import describe
from cloth_sim_ros.study.results import DONE
from cloth_sim_ros.study.results import FAILED
from cloth_sim_ros.study.results import REFUSED
from cloth_sim_ros.study.results import Result
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.results import Run
from cloth_sim_ros.study.results import STOPPED
from cloth_sim_ros.study.results import unmade
from cloth_sim_ros.study.workers import Workers
import numpy as np
from tqdm import tqdm

_DEFAULTS = {field.name: field.default for field in SCENE_FIELDS}
_Kind = tuple[str, str]
_LOG_PERIOD = 30.0  # [s]; chosen: some lines in the log of a study of minutes
_BAR = '{desc} |{bar}| {n_fmt}/{total_fmt} runs, {elapsed}{postfix}'


def perform(run: Run, shares_processor: bool) -> Result:
    """
    Make ``run``; what goes wrong is in the result.

    :param shares_processor: other runs are made at the same time: a software device gets no
        worker threads, as each process has a processor of its own to fill
    """
    if shares_processor:
        # Read when the first context of this process is made.
        os.environ.setdefault('LP_NUM_THREADS', '0')
    begin = time.perf_counter()
    try:
        module, _, name = run.function.partition(':')
        returned = getattr(import_module(module), name)(dict(run.scene), **run.settings)
        values, arrays = _sorted(returned)
        result = Result(
            **describe(run), outcome=DONE, reason='', values=values,
            device=values.pop('device'), wall_seconds=time.perf_counter() - begin, arrays=arrays)
        result.line()
    except ClothSimError as error:
        outcome = STOPPED if isinstance(error, NonFiniteStateError) else REFUSED
        return unmade(run, outcome, str(error), wall_seconds=time.perf_counter() - begin)
    # One run of many: whatever is wrong with it, the others are made.
    except Exception as error:
        return unmade(
            run, FAILED, f'{type(error).__name__}: {error}',
            wall_seconds=time.perf_counter() - begin)
    return result


def _sorted(returned: dict[str, Any]) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    arrays = {name: value for name, value in returned.items() if isinstance(value, np.ndarray)}
    return {name: value for name, value in returned.items() if name not in arrays}, arrays


class Forecast:
    """
    Expects each run to take as long for its work as the ended runs of its kind did.

    A kind is the function with the mode; its work grows with the nodes and the steps. What runs at
    the same time is taken from the wall time of the study itself.

    :param runs: those to be made
    """

    def __init__(self, runs: Iterable[Run]) -> None:
        """Begin with all runs to be made."""
        self._left = {run.key: (_kind(run), _work(run)) for run in runs}
        # Time [s] and work of the finished runs, by kind.
        self._ended: dict[_Kind, list[tuple[float, float]]] = {}

    def end(self, result: Result) -> None:
        """Record a finished run."""
        kind, work = self._left.pop(result.key)
        self._ended.setdefault(kind, []).append((result.wall_seconds, work))

    def seconds_left(self, elapsed: float) -> float | None:
        """
        Return the wall time until the last run ends; None while nothing is known [s].

        :param elapsed: wall time since the first run began [s]
        """
        ended = [entry for entries in self._ended.values() for entry in entries]
        spent = sum(seconds for seconds, _ in ended)
        if spent <= 0.0:
            return None
        expected = sum(
            work * _rate(self._ended.get(kind) or ended) for kind, work in self._left.values())
        return expected * elapsed / spent


def in_minutes(seconds: float) -> str:
    """Return a forecast in words, to the nearest 10 s or minute: it is no more exact."""
    if seconds < 95.0:
        return f'about {max(10 * round(seconds / 10.0), 10)} s'
    if seconds < 5400.0:
        return f'about {round(seconds / 60.0)} min'
    return f'about {seconds / 3600.0:.1f} h'


def _rate(entries: list[tuple[float, float]]) -> float:
    return sum(seconds for seconds, _ in entries) / sum(work for _, work in entries)


def _kind(run: Run) -> _Kind:
    return run.function, str(run.scene.get('mode', _DEFAULTS['mode']))


def _work(run: Run) -> float:
    """Return roughly what the time of the run is in proportion to; 1 where it is not known."""
    rows, cols, dt, refine = (
        run.scene.get(name, _DEFAULTS[name]) for name in ('rows', 'cols', 'dt', 'refine'))
    repeats = len(run.settings.get('settings', [None])) * run.settings.get('rounds', 1)
    try:
        return max(rows * cols * refine * repeats / dt, 1.0)
    except (TypeError, ZeroDivisionError):
        return 1.0  # a scene that will be refused


def make_runs(
        runs: Sequence[Run], results: ResultsFolder, workers: Workers, *, title: str,
        alone: bool = False) -> list[Result]:
    """
    Return the result of each run, in their order.

    A run that ``results`` holds is not made again, unless it failed. Interrupted, all that have
    ended are kept.

    :param title: in front of the progress bar
    :param alone: one at a time, each in a fresh process of this machine: to measure wall time
    :raises ClothSimError: when the code has changed since the first run; that run is not kept
    """
    distinct = {run.key: run for run in runs}
    found = {key: results.find(key) for key in distinct}
    todo = [distinct[key] for key, result in found.items()
            if result is None or not result.is_final]
    if todo:
        with tqdm(
                total=len(distinct), initial=len(distinct) - len(todo), bar_format=_BAR,
                desc=title, disable=None) as bar:
            forecast = Forecast(todo)
            begin = told = time.monotonic()
            before = len(distinct) - len(todo)
            # Closed at once, so that an interrupt ends the processes.
            with closing(_make_alone(todo) if alone else _make(todo, workers)) as made:
                for number, result in enumerate(made, 1):
                    if result.key not in distinct:
                        raise ClothSimError(
                            'a run was made by other code than the study was begun with: leave '
                            'the files of cloth_sim_ros as they are while it runs, the same on '
                            'all machines, and start it again')
                    results.add(result)
                    forecast.end(result)
                    if result.outcome == FAILED:
                        bar.write(f'failed: {result.reason}')
                    now = time.monotonic()
                    left = forecast.seconds_left(now - begin)
                    bar.set_postfix_str(f'{in_minutes(left)} left' if left else '', refresh=False)
                    bar.update()
                    # A log has no bar, but is to show that the work goes on.
                    if bar.disable and now - told > _LOG_PERIOD:
                        told = now
                        print(
                            f'cloth_sim study: {title}, {before + number} of {len(distinct)} runs'
                            f'{f", {in_minutes(left)} left" if left else ""}', file=sys.stderr)
    return [_kept(results, run) for run in runs]


def _kept(results: ResultsFolder, run: Run) -> Result:
    result = results.find(run.key)
    assert result is not None  # it was there, or has been added
    return result


def _make(runs: Sequence[Run], workers: Workers) -> Generator[Result, None, None]:
    left = list(runs)
    while left:
        processes = min(workers.processes, len(left))
        suspects: list[Run] = []
        done = set()
        with workers.executor(processes) as (executor, at_once):
            for run, result in _ended(executor, left, at_once):
                done.add(run.key)
                if result is None:
                    suspects.append(run)
                else:
                    yield result
        left = [run for run in left if run.key not in done]
        # Any of the runs that were under way may be the one that ended its process.
        yield from _make_alone(suspects)


def _make_alone(runs: Iterable[Run]) -> Generator[Result, None, None]:
    for run in runs:
        with Workers().executor(1) as (executor, _):
            for _, result in _ended(executor, [run], 1):
                yield result or unmade(
                    run, FAILED, 'its process ended without a result, as happens when memory runs '
                    'out')


def _ended(
        executor: Executor, runs: Sequence[Run],
        at_once: int) -> Iterator[tuple[Run, Result | None]]:
    """Yield each run with its result; None where the process that made it may have died."""
    waiting = iter(runs)
    under_way: dict[Future[Result], Run] = {}
    is_broken = False
    while True:
        if not is_broken:
            try:
                for run in islice(waiting, at_once - len(under_way)):
                    under_way[executor.submit(perform, run, at_once > 1)] = run
            except BrokenExecutor:
                is_broken = True
        if not under_way:
            return
        for future in wait(under_way, return_when=FIRST_COMPLETED).done:
            run = under_way.pop(future)
            if future.cancelled():
                raise ClothSimError(
                    'the Dask scheduler is gone: restart it and the study, which resumes where it '
                    'stopped')
            error = future.exception()
            if isinstance(error, BrokenExecutor):
                is_broken = True
                yield run, None
            elif error is not None:
                yield run, unmade(run, FAILED, f'{type(error).__name__}: {error}')
            else:
                yield run, future.result()
