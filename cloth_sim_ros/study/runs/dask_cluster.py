# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The workers of a Dask scheduler, behind the interface of concurrent.futures."""

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager

from cloth_sim_ros.sim.errors import ClothSimError

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
