# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The Python class of a message type that a recording names."""

from importlib import import_module
import re

from cloth_sim_ros.files.echo import shown
from cloth_sim_ros.recording.message_decoder import recorded_type_hash
from cloth_sim_ros.recording.message_definition import type_hash
from cloth_sim_ros.sim.errors import ClothSimError
from rclpy.type_support import check_for_type_support
from rosbags.interfaces import MessageDefinition
from rosidl_generator_py.import_type_support_impl import UnsupportedTypeSupport

_TYPE_NAME = re.compile(r'([a-z][a-z0-9_]*)/msg/([A-Z][A-Za-z0-9]*)')


def message_class(type_name: str, definition: MessageDefinition) -> type:
    """
    Return the class of ``type_name``, such as std_msgs/msg/Header.

    :param definition: of the recorded messages, as far as the bag holds it
    :raises ClothSimError: when it is not installed, or not as it was when recorded
    """
    match = _TYPE_NAME.fullmatch(type_name)
    if match is None:
        raise ClothSimError(
            f'{shown(type_name)} is not a message type: record it again, with a type like '
            'std_msgs/msg/Header')
    package, name = match.groups()
    try:
        found = getattr(import_module(f'{package}.msg'), name)
        check_for_type_support(found)
    except (ImportError, AttributeError, UnsupportedTypeSupport) as error:
        raise ClothSimError(
            f'the message type {type_name} is not installed: install or build the package '
            f'{package}, and source its setup') from error
    if not _is_as_installed(type_name, definition):
        raise ClothSimError(
            f'the message type {type_name} had another definition when this was recorded: play it '
            f'with the {package} of that time')
    return found


def _is_as_installed(type_name: str, definition: MessageDefinition) -> bool:
    recorded = recorded_type_hash(type_name, definition)
    try:
        return recorded in ('', type_hash(type_name))
    except (ClothSimError, OSError):
        return True  # an installed package without its files can't tell
