# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Make the runs of a study that are not there yet, and keep each as it ends."""

from collections.abc import Iterable
from collections.abc import Iterator
from collections.abc import Sequence
from concurrent.futures import BrokenExecutor
from concurrent.futures import Executor
from concurrent.futures import FIRST_COMPLETED
from concurrent.futures import Future
from concurrent.futures import wait
from contextlib import closing
from itertools import islice

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.runs.forecast import Forecast
from cloth_sim_ros.study.runs.forecast import in_minutes
from cloth_sim_ros.study.runs.perform import perform
from cloth_sim_ros.study.runs.result import FAILED
from cloth_sim_ros.study.runs.result import Result
from cloth_sim_ros.study.runs.result import unmade
from cloth_sim_ros.study.runs.results_folder import ResultsFolder
from cloth_sim_ros.study.runs.run import Run
from cloth_sim_ros.study.runs.workers import Workers
from tqdm import tqdm

_BAR = '{desc} |{bar}| {n_fmt}/{total_fmt} runs, {elapsed}{postfix}'


def make_runs(
        runs: Sequence[Run], results: ResultsFolder, workers: Workers, *, title: str,
        alone: bool = False) -> list[Result]:
    """
    Return the result of each run, in their order.

    A run that ``results`` holds is not made again, unless it failed. Interrupted, all that have
    ended are kept.

    :param title: in front of the progress bar
    :param alone: one at a time, each in a fresh process of this machine: to measure wall time
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
            # Closed at once, so that an interrupt ends the processes.
            with closing(_make_alone(todo) if alone else _make(todo, workers)) as made:
                for result in made:
                    results.add(result)
                    forecast.end(result)
                    if result.outcome == FAILED:
                        bar.write(f'failed: {result.reason}')
                    left = forecast.seconds_left(bar.format_dict['elapsed'])
                    bar.set_postfix_str(f'{in_minutes(left)} left' if left else '', refresh=False)
                    bar.update()
    return [results.find(run.key) for run in runs]


def _make(runs: Sequence[Run], workers: Workers) -> Iterator[Result]:
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


def _make_alone(runs: Iterable[Run]) -> Iterator[Result]:
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
