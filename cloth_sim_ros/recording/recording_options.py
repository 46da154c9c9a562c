# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How a recording is laid out on the disk: its files, its limit, and when it is put there."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

MAX_SIZE_SETTING = 'recording.max_size'


@dataclass(frozen=True)
class RecordingOptions:
    """
    The options of a recording; the first two are those of rosbag2.

    :param max_bagfile_size: of one file, before the next one is begun [bytes]; 0 for no limit
    :param max_bagfile_duration: recorded time of one file [s]; 0 for no limit
    :param max_size: of all files of the recording, which is completed there [bytes]; 0 for none
    :param fsync: True to wait for the disk at each flush, not only at the end
    """

    max_bagfile_size: int = 0
    max_bagfile_duration: float = 0.0
    max_size: int = 0
    fsync: bool = False

    @classmethod
    def from_values(cls, values: Mapping[str, Any]) -> 'RecordingOptions':
        """Return the options that a node's parameters, by name, ask for."""
        return cls(
            max_bagfile_size=values['recording.max_bagfile_size'],
            max_bagfile_duration=values['recording.max_bagfile_duration'],
            max_size=values[MAX_SIZE_SETTING],
            fsync=values['recording.fsync'])

    @property
    def splits(self) -> bool:
        """Return whether the recording can have several files."""
        return self.max_bagfile_size > 0 or self.max_bagfile_duration > 0.0
