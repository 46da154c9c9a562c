# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Options of a recording that the writer of rosbag2 does not support."""

from cloth_sim_ros.recording.bag_folder import MAX_SIZE_SETTING
from cloth_sim_ros.recording.bag_folder import RecordingOptions
from cloth_sim_ros.sim.errors import ClothSimError


def check_options(options: RecordingOptions) -> None:
    """Raise ClothSimError where ``options`` ask for more than rosbag2 offers."""
    for setting, value in ((MAX_SIZE_SETTING, options.max_size), (
            'recording.fsync', options.fsync)):
        if value:
            raise ClothSimError(
                f'{setting} is {str(value).lower()}, and rosbag2_py, which writes recordings '
                'where mcap is missing, has no such setting: run `pip install mcap`, or leave '
                f'{setting} out')
