# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Who makes the runs: processes of this machine, or those of a Dask scheduler."""

from argparse import ArgumentParser
from argparse import Namespace
from collections.abc import Iterator
from concurrent.futures import Executor
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
import multiprocessing
import os
import signal
from threading import Thread

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.errors import ClothSimError


@cache
def process_context() -> Context:
    """Return the context of this process, made when it is first requested; not to be closed."""
    return Context(single_thread=True)


_TIMEOUT = 10.0


@contextmanager
def dask_executor(address: str) -> Iterator[tuple[Executor, int]]:
    """
    Lend an executor for the cluster at ``address``, and how many runs it makes at a time.

    :raises ClothSimError: when Dask is missing, nobody answers, or the workers don't fit
    """
    try:
        from distributed import Client
    except ImportError as error:
        raise ClothSimError(
            f'--scheduler needs Dask, and {error.name} is missing: pip install distributed, or '
            'leave --scheduler out to use the processes of this machine') from error
    try:
        client = Client(address, timeout=_TIMEOUT)
    except (OSError, ValueError) as error:
        raise ClothSimError(
            f'no Dask scheduler responds at {address}: start one with `dask scheduler`, and give '
            'the address it prints') from error
    with client:
        threads = client.nthreads()
        if not threads:
            raise ClothSimError(
                f'the Dask scheduler at {address} has no workers: start some with '
                f'`dask worker {address} --nworkers auto --nthreads 1`')
        if max(threads.values()) > 1:
            raise ClothSimError(
                f'a Dask worker at {address} has {max(threads.values())} threads, and a GL '
                'context belongs to one: start workers with --nworkers auto --nthreads 1')
        with client.get_executor(pure=False) as executor:
            yield executor, len(threads)


@dataclass(frozen=True)
class Workers:
    """
    Where runs are made.

    :param jobs: processes of this machine; None for as many as it lets this process use
    :param scheduler: address of a Dask scheduler, which takes the place of these processes
    """

    jobs: int | None = None
    scheduler: str = ''

    @property
    def processes(self) -> int:
        """Return how many processes of this machine make runs at the same time."""
        return self.jobs or len(os.sched_getaffinity(0))

    @contextmanager
    def executor(self, processes: int) -> Iterator[tuple[Executor, int]]:
        """
        Lend an executor, and how many runs it makes at the same time.

        :param processes: of this machine
        :raises ClothSimError: when the scheduler can't be used
        """
        if self.scheduler:
            with dask_executor(self.scheduler) as lent:
                yield lent
            return
        others = set(multiprocessing.active_children())
        # A GL context does not survive a fork.
        executor = ProcessPoolExecutor(
            processes, mp_context=multiprocessing.get_context('spawn'),
            initializer=_end_with_parent)
        try:
            yield executor, processes
        except BaseException:
            executor.shutdown(wait=False, cancel_futures=True)
            for process in set(multiprocessing.active_children()) - others:
                process.terminate()
            raise
        executor.shutdown()


def _end_with_parent() -> None:
    # Ctrl-C reaches every process of the terminal: the parent says what there is to say.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    # Where the parent is killed, a worker would wait for more runs for ever.
    Thread(target=_wait_for_parent, daemon=True).start()


def _wait_for_parent() -> None:
    parent = multiprocessing.parent_process()
    assert parent is not None  # this is a worker
    parent.join()
    os._exit(1)


def checked_workers(jobs: int | None, scheduler: str) -> Workers:
    """Return the workers; ClothSimError when there can't be so many."""
    if jobs is not None and jobs < 1:
        raise ClothSimError(f'--jobs must be 1 or more, got {jobs}')
    return Workers(jobs, scheduler)


# The arguments of every study that makes runs.


def add_run_arguments(parser: ArgumentParser, folder: str) -> None:
    """Add --jobs, --scheduler and --out; ``folder`` is the default of the last."""
    parser.add_argument('--jobs', type=int, metavar='N',
                        help='number of worker processes (default: one per CPU core)')
    parser.add_argument('--scheduler', default='', metavar='tcp://HOST:PORT',
                        help='use the workers of this Dask scheduler instead')
    parser.add_argument('--out', default=folder, metavar='DIR',
                        help='folder of the results; existing runs are not repeated '
                             '(default: %(default)s)')


def workers_of(args: Namespace) -> Workers:
    """Return who makes the runs; ClothSimError when an argument is wrong."""
    return checked_workers(args.jobs, args.scheduler)
