# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A bag that rosbag2_py writes, where a sourced ROS has that and mcap is not installed."""

import errno
from math import ceil
import os
from pathlib import Path
import shutil

from cloth_sim_ros.files.regular_file import open_regular
from cloth_sim_ros.recording.bag_folder import MAGIC
from cloth_sim_ros.recording.bag_folder import RecordingOptions
from cloth_sim_ros.recording.bag_folder import sync_file
from cloth_sim_ros.recording.bag_folder import sync_folder
from cloth_sim_ros.recording.bag_metadata import BagChannel
from cloth_sim_ros.recording.bag_metadata import folder_metadata
from cloth_sim_ros.recording.bag_metadata import METADATA_NAME
from cloth_sim_ros.recording.bag_metadata import PACKAGE
from cloth_sim_ros.recording.bag_metadata import project_version
from cloth_sim_ros.recording.bag_metadata import yaml_text
from cloth_sim_ros.recording.rosbag2_limits import check_options
import rosbag2_py

# In whose format a channel holds its profiles.
_METADATA_VERSION = 9
# Below this much free disk a recording ends [bytes]: room for a chunk of rosbag2, 768 KiB, the
# index and metadata.yaml.
_LEAST_FREE = 2**21


class Rosbag2Writer:
    """
    Writes messages into ``folder`` by the SequentialWriter of rosbag2; used from one thread.

    A file is split as rosbag2 does: durations are whole seconds, and latched messages are not
    repeated. Chunks and metadata.yaml are written when rosbag2 writes them. It does not report a
    write that fails, so free disk space is checked meanwhile, and the files at the end.

    :param folder: empty, the bag takes its name
    :raises ClothSimError: when ``options`` ask for what rosbag2 can't do
    :raises OSError: when rosbag2 can't make it
    """

    def __init__(self, folder: Path, options: RecordingOptions = RecordingOptions()) -> None:
        """Open the bag."""
        check_options(options)
        self._folder = folder
        self._topics: set[str] = set()
        self._writer = rosbag2_py.SequentialWriter()
        # rosbag2 makes the folder itself, and refuses one that is there.
        folder.rmdir()
        try:
            self._writer.open(
                rosbag2_py.StorageOptions(
                    uri=str(folder), storage_id='mcap',
                    max_bagfile_size=options.max_bagfile_size,
                    max_bagfile_duration=ceil(options.max_bagfile_duration),
                    storage_preset_profile='zstd_fast',
                    custom_data={PACKAGE: project_version()}),
                rosbag2_py.ConverterOptions('cdr', 'cdr'))
        except RuntimeError as error:
            raise OSError(str(error)) from error

    def write(self, channel: BagChannel, data: bytes, time: int) -> None:
        """
        Write the serialised message ``data`` at ``time`` [ns].

        :raises OSError: when rosbag2 can't write it
        """
        try:
            if channel.name not in self._topics:
                self._writer.create_topic(_topic(channel, len(self._topics)))
                self._topics.add(channel.name)
            self._writer.write(channel.name, data, time)
        except RuntimeError as error:
            raise OSError(str(error)) from error

    def flush(self) -> None:
        """
        Check the disk: rosbag2 writes each chunk when it is full, and can't be asked to.

        :raises OSError: when the disk is nearly full
        """
        if shutil.disk_usage(self._folder).free < _LEAST_FREE:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    def finish(self) -> None:
        """
        Complete the bag, and wait until the disk has it.

        :raises OSError: when rosbag2 has not written all of it
        """
        self.abandon()
        self._check_files()
        for path in self._folder.iterdir():
            sync_file(path)
        sync_folder(self._folder)
        sync_folder(self._folder.parent)

    def abandon(self) -> None:
        """Close the bag: rosbag2 writes its index and metadata.yaml."""
        try:
            self._writer.close()
        except RuntimeError as error:
            raise OSError(str(error)) from error

    def _check_files(self) -> None:
        names = folder_metadata(self._folder).get('relative_file_paths')
        if not names:
            raise OSError(f'rosbag2 has not written {METADATA_NAME}')
        for name in names:
            with open_regular(self._folder / name) as file:
                file.seek(-len(MAGIC), os.SEEK_END)
                if file.read() != MAGIC:
                    raise OSError(f'rosbag2 has not written all of {name}')


def _topic(channel: BagChannel, number: int) -> rosbag2_py.TopicMetadata:
    return rosbag2_py.TopicMetadata(
        id=number, name=channel.name, type=channel.type_name,
        serialization_format=channel.message_encoding,
        offered_qos_profiles=rosbag2_py.to_rclcpp_qos_vector(
            yaml_text(channel.qos), _METADATA_VERSION),
        type_description_hash=channel.type_hash)
