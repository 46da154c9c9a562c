# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The arguments of verbs that read recordings, and of those that record."""

from argparse import ArgumentParser
from argparse import ArgumentTypeError
from argparse import Namespace
import math

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.files.echo import shown

# The node's parameter that each stands for.
_PARAMETERS = {
    'max_bag_size': 'recording.max_bagfile_size',
    'max_bag_duration': 'recording.max_bagfile_duration',
    'max_recording_size': 'recording.max_size',
    'fsync': 'recording.fsync',
}


def add_recording_arguments(parser: ArgumentParser) -> None:
    """Add the recording and the name of its node."""
    parser.add_argument(
        'recording', metavar='BAG',
        help='folder of a recording of this project or of ros2 bag, or its mcap or db3 file')
    add_node_argument(parser)


def add_node_argument(parser: ArgumentParser) -> None:
    """Add the name of the recorded node."""
    parser.add_argument(
        '--node', metavar='NAME',
        help='name of the recorded node, including its namespace; needed if there are several')


def open_recording(args: Namespace) -> Recording:
    """Return the recording that the arguments mean."""
    return Recording(args.recording, args.node)


def list_of_times(text: str) -> list[float]:
    """Read times [s], as in 0.5,1,2."""
    try:
        times = [float(part) for part in text.split(',')]
    except ValueError:
        times = [math.nan]
    if not all(math.isfinite(time) for time in times):
        raise ArgumentTypeError(f'{shown(text)} is not a list of times: write them as in 0.5,1,2')
    return sorted(times)


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
