# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The arguments of every verb that reads a recording."""

from argparse import ArgumentParser
from argparse import ArgumentTypeError
from argparse import Namespace
import math

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.files.errors import shown


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


def finite_time(text: str) -> float:
    """Read a time [s], as in 1.5."""
    try:
        time = float(text)
    except ValueError:
        time = math.nan
    if not math.isfinite(time):
        raise ArgumentTypeError(f'{shown(text)} is not a time: write it as in 1.5')
    return time
