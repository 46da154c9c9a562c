# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which library writes recordings: mcap, or else the rosbag2_py of a sourced ROS."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import Protocol
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cloth_sim_ros.recording.bag_folder import RecordingOptions
    from cloth_sim_ros.recording.bag_metadata import BagChannel

# The first that is there is taken: mcap writes a bag of which a killed process loses least.
LIBRARIES = ('mcap', 'rosbag2_py')


class Writer(Protocol):
    """What a recorder asks of a bag that it writes, from one thread."""

    def write(self, channel: BagChannel, data: bytes, time: int) -> None:
        """Write the serialised message ``data`` at ``time`` [ns]."""

    def flush(self) -> None:
        """Hand everything so far to the operating system, as far as the library can."""

    def finish(self) -> None:
        """Complete the bag, and wait until the disk has it."""

    def abandon(self) -> None:
        """Close the bag after a failed write."""


def is_importable(module: str) -> bool:
    """Return whether ``module`` is installed; it is not imported."""
    return find_spec(module) is not None


def chosen_library(is_there: Callable[[str], bool] = is_importable) -> str:
    """
    Return which of LIBRARIES writes recordings; empty where none of them is there.

    :param is_there: returns whether a module can be imported
    """
    return next((library for library in LIBRARIES if is_there(library)), '')


def library_report(library: str) -> str:
    """Return a note to the user on the chosen ``library``; empty for the usual one."""
    if library == LIBRARIES[0]:
        return ''
    if library:
        return (
            f'recordings are written by {library}, as mcap is not installed: a node that is '
            'killed loses what rosbag2 has not written, so run `pip install mcap` to lose less')
    return (
        f'recordings are refused, as neither {" nor ".join(LIBRARIES)} is installed: run `pip '
        'install mcap`, or source a ROS that has rosbag2_py, before starting the node')


def open_writer(library: str, folder: Path, options: RecordingOptions) -> Writer:
    """
    Open a bag in the empty folder ``folder``, written by ``library``.

    :raises ModuleNotFoundError: where ``library`` is empty, or is gone since
    :raises ClothSimError: where ``options`` ask for what it can't do
    :raises OSError: when no file can be made
    """
    if library == 'rosbag2_py':
        from cloth_sim_ros.recording.rosbag2_writer import Rosbag2Writer
        return Rosbag2Writer(folder, options)
    from cloth_sim_ros.recording.bag_writer import BagWriter
    return BagWriter(folder, options)
