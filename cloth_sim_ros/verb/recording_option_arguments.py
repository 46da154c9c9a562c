# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The arguments of a verb that records, named as those of `ros2 bag record` are."""

from argparse import ArgumentParser
from argparse import Namespace

# The node's parameter that each stands for.
_PARAMETERS = {
    'max_bag_size': 'recording.max_bagfile_size',
    'max_bag_duration': 'recording.max_bagfile_duration',
    'max_recording_size': 'recording.max_size',
    'fsync': 'recording.fsync',
}


def add_recording_options(parser: ArgumentParser) -> None:
    """Add the arguments for files, limit and fsync of a recording."""
    parser.add_argument(
        '--max-bag-size', type=int, metavar='BYTES',
        help='split the recording into files of this size')
    parser.add_argument(
        '--max-bag-duration', type=float, metavar='T',
        help='split the recording every T seconds of simulated time')
    parser.add_argument(
        '--max-recording-size', type=int, metavar='BYTES',
        help='stop the recording at this total size; the simulation continues')
    parser.add_argument(
        '--fsync', action='store_true', default=None,
        help='sync the recording to disk at every flush, twice a second')


def recording_changes(args: Namespace) -> list[str]:
    """Return the arguments that were given as changes of parameters, name=value."""
    given = {name: getattr(args, name) for name in _PARAMETERS}
    return [
        f'{_PARAMETERS[name]}={str(value).lower()}' for name, value in given.items()
        if value is not None]
