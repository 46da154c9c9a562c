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

"""What rosbag2 wants to know of a bag before it opens it."""

from collections.abc import Mapping
import os
from pathlib import Path
from typing import Any

from cloth_sim_ros.messages.topic import Topic
from cloth_sim_ros.recording.message_definition import type_hash
from cloth_sim_ros.recording.offered_qos import offered_qos
from cloth_sim_ros.recording.yaml_text import yaml_text

VERSION = 9
_NO_TIME_YET = 2**63 - 1


class BagMetadata:
    """
    Topics, message counts and times of a bag of one file.

    :param file_name: of the mcap file, without its folder
    :param custom_data: what else is to be known of the bag, words by words
    """

    def __init__(self, file_name: str, custom_data: Mapping[str, str] | None = None) -> None:
        """Begin an empty bag."""
        self._file_name = file_name
        self._custom_data = dict(custom_data or {})
        self._topics: dict[str, dict[str, Any]] = {}
        self._begin = _NO_TIME_YET
        self._end = 0

    def add_topic(self, name: str, topic: Topic) -> None:
        """Note that ``topic`` is in the bag, under its full ``name``."""
        self._topics[name] = {
            'topic_metadata': {
                'name': name,
                'type': topic.type_name,
                'serialization_format': 'cdr',
                'offered_qos_profiles': offered_qos(topic),
                'type_description_hash': type_hash(topic.type_name),
            },
            'message_count': 0,
        }

    def add_message(self, name: str, time: int) -> None:
        """Count a message of the topic ``name`` at ``time`` [ns]."""
        self._topics[name]['message_count'] += 1
        self._begin = min(self._begin, time)
        self._end = max(self._end, time)

    def text(self) -> str:
        """Return the content of the metadata record of the mcap file."""
        return yaml_text(self._content())

    def write(self, folder: Path) -> None:
        """Write metadata.yaml; whoever reads it meanwhile finds the old one or the new one."""
        fresh = folder / 'metadata.yaml.new'
        try:
            fresh.write_text(yaml_text({'rosbag2_bagfile_information': self._content()}) + '\n')
            os.replace(fresh, folder / 'metadata.yaml')
        except OSError:
            fresh.unlink(missing_ok=True)
            raise

    def _content(self) -> dict[str, Any]:
        message_count = sum(topic['message_count'] for topic in self._topics.values())
        duration = max(self._end - self._begin, 0)
        return {
            'version': VERSION,
            'storage_identifier': 'mcap',
            'duration': {'nanoseconds': duration},
            'starting_time': {'nanoseconds_since_epoch': self._begin},
            'message_count': message_count,
            'topics_with_message_count': list(self._topics.values()),
            'compression_format': '',
            'compression_mode': '',
            'relative_file_paths': [self._file_name],
            'files': [{
                'path': self._file_name,
                'starting_time': {'nanoseconds_since_epoch': self._begin},
                'duration': {'nanoseconds': duration},
                'message_count': message_count,
            }],
            'custom_data': self._custom_data or None,
            'ros_distro': os.environ.get('ROS_DISTRO', 'jazzy'),
        }
