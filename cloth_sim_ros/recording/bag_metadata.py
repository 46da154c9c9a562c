# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The metadata.yaml of a bag, in the style of rosbag2: its topics, and who made it."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.metadata import PackageNotFoundError
from importlib.metadata import version
import os
from pathlib import Path
from typing import Any

from cloth_sim_ros.files.checked_yaml import load_yaml
from cloth_sim_ros.sim.errors import ClothSimError
import yaml

PACKAGE = 'cloth_sim_ros'


@cache
def project_version() -> str:
    """Return the version of the installed package; empty where it is not installed."""
    try:
        return version(PACKAGE)
    except PackageNotFoundError:
        return ''


# Metadata of a topic in a bag: its type, the definition of that, and its quality of service.

# Upper bound of the size of a channel and its schema without their texts [bytes].
_RECORD_BYTES = 128


@dataclass(frozen=True)
class BagChannel:
    """
    A topic as it is written into mcap files and metadata.yaml.

    :param name: in the graph
    :param type_name: such as std_msgs/msg/Header
    :param definition_encoding: ros2msg or ros2idl
    :param definition: text of the type and of all it is made of
    :param metadata: of the channel in mcap files
    :param qos: profiles that were offered, as in metadata.yaml of version 9
    :param type_hash: that publishers of the type announce; empty where it is not known
    :param transient_local: True where late subscribers get the last message
    """

    name: str
    type_name: str
    definition_encoding: str
    definition: bytes
    metadata: Mapping[str, str]
    qos: list[dict[str, Any]]
    type_hash: str
    transient_local: bool = False
    message_encoding: str = 'cdr'

    @property
    def key(self) -> tuple[str, str]:
        """Return name and type: a bag can have one name with several types."""
        return self.name, self.type_name

    @property
    def length(self) -> int:
        """Get a bound of the length of its records in an mcap file [bytes]."""
        texts = (self.name, self.type_name, *self.metadata.keys(), *self.metadata.values())
        return _RECORD_BYTES + len(self.definition) + sum(len(text.encode()) for text in texts)


# The metadata.yaml of a bag, in the style of rosbag2.

# Ten times as fast, where PyYAML was built with libyaml.
_DUMPER = getattr(yaml, 'CSafeDumper', yaml.SafeDumper)
METADATA_NAME = 'metadata.yaml'
FRESH_METADATA_NAME = f'{METADATA_NAME}.new'  # while it is being written
VERSION = 9
_NO_TIME_YET = 2**63 - 1


def yaml_text(content: Any) -> str:
    """Return ``content`` as block YAML, its keys in the order given."""
    return yaml.dump(content, Dumper=_DUMPER, sort_keys=False, default_flow_style=False).strip()


def folder_metadata(folder: Path) -> Mapping[str, Any]:
    """
    Return the metadata that rosbag2 has written for the bag in ``folder``.

    It is empty when metadata.yaml is missing, broken or hostile: the files have the same data.
    """
    try:
        content = load_yaml(folder / METADATA_NAME)
    except ClothSimError:
        return {}
    information = content.get('rosbag2_bagfile_information') if isinstance(
        content, Mapping) else None
    return information if isinstance(information, Mapping) else {}


@dataclass
class _Span:
    """Number and times [ns] of the messages of a file, or of all files."""

    begin: int = _NO_TIME_YET
    end: int = 0
    message_count: int = 0

    def add(self, time: int) -> None:
        """Count a message at ``time``."""
        self.begin = min(self.begin, time)
        self.end = max(self.end, time)
        self.message_count += 1

    def content(self) -> dict[str, Any]:
        """Return what metadata.yaml has of it."""
        return {
            'duration': {'nanoseconds': max(self.end - self.begin, 0)},
            'starting_time': {'nanoseconds_since_epoch': self.begin},
            'message_count': self.message_count,
        }


class BagMetadata:
    """
    Topics, message counts and times of a bag.

    :param file_name: of its first mcap file, without the folder
    :param custom_data: what else is to be known of the bag, words by words
    """

    def __init__(self, file_name: str, custom_data: Mapping[str, str] | None = None) -> None:
        """Begin an empty bag."""
        self._custom_data = dict(custom_data or {})
        self._topics: dict[tuple[str, str], dict[str, Any]] = {}
        self._all = _Span()
        self._files: dict[str, _Span] = {}
        self.begin_file(file_name)

    def begin_file(self, name: str) -> None:
        """Count what comes from now on as in the file ``name``."""
        self._file = self._files.setdefault(name, _Span())

    def add_topic(self, channel: BagChannel) -> None:
        """Note that ``channel`` is in the bag; does nothing when it is noted already."""
        if channel.key in self._topics:
            return
        self._topics[channel.key] = {
            'topic_metadata': {
                'name': channel.name,
                'type': channel.type_name,
                'serialization_format': channel.message_encoding,
                'offered_qos_profiles': channel.qos,
                'type_description_hash': channel.type_hash,
            },
            'message_count': 0,
        }

    def add_message(self, channel: BagChannel, time: int) -> None:
        """Count a message of ``channel`` at ``time`` [ns]."""
        self._topics[channel.key]['message_count'] += 1
        self._all.add(time)
        self._file.add(time)

    def text(self) -> str:
        """Return the content of the metadata record of the mcap file."""
        return yaml_text(self._content())

    def write(self, folder: Path, *, fsync: bool = False) -> None:
        """Write metadata.yaml; whoever reads it meanwhile finds the old one or the new one."""
        fresh = folder / FRESH_METADATA_NAME
        try:
            with open(fresh, 'w', encoding='utf-8') as stream:
                stream.write(
                    yaml_text({'rosbag2_bagfile_information': self._content()}) + '\n')
                stream.flush()
                if fsync:
                    os.fsync(stream.fileno())
            os.replace(fresh, folder / METADATA_NAME)
        except OSError:
            fresh.unlink(missing_ok=True)
            raise

    def _content(self) -> dict[str, Any]:
        return {
            'version': VERSION,
            'storage_identifier': 'mcap',
            **self._all.content(),
            'topics_with_message_count': list(self._topics.values()),
            'compression_format': '',
            'compression_mode': '',
            'relative_file_paths': list(self._files),
            'files': [{'path': name, **span.content()} for name, span in self._files.items()],
            'custom_data': self._custom_data or None,
            'ros_distro': os.environ.get('ROS_DISTRO', 'jazzy'),
        }
