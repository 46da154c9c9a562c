# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The arguments of every study that makes runs."""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_ros.study.runs.workers import checked_workers
from cloth_sim_ros.study.runs.workers import Workers


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
