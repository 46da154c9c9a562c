# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
