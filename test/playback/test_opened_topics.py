# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""From the name of a message type to its class."""

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.playback.opened_topics import message_class
from cloth_sim_ros.recording.message_definition import message_definition
from cloth_sim_ros.sim.errors import ClothSimError
import pytest
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import MessageDefinitionFormat

NAME = 'cloth_sim_interfaces/msg/ClothStats'
UNKNOWN = MessageDefinition(MessageDefinitionFormat.NONE, '')


def definition(text):
    """Return a definition in the language of .msg files."""
    return MessageDefinition(MessageDefinitionFormat.MSG, text)


@pytest.mark.parametrize('recorded', [UNKNOWN, definition(message_definition(NAME))])
def test_an_installed_type_is_found(recorded):
    """A recording that could be played would not be."""
    assert message_class(NAME, recorded) is ClothStats


@pytest.mark.parametrize('change', [
    ('float64 max_strain', 'float32 max_strain'), ('max_strain', 'largest_strain')])
def test_a_type_that_has_changed_is_refused(change):
    """Readers would get the bytes of one type as another: numbers without sense."""
    text = message_definition(NAME)
    assert change[0] in text
    with pytest.raises(ClothSimError, match='had another definition when this was recorded'):
        message_class(NAME, definition(text.replace(*change)))


@pytest.mark.parametrize('name', [
    'no_such_msgs/msg/Thing', 'sensor_msgs/msg/NoSuchThing', 'os/msg/Path'])
def test_what_is_not_installed_is_named(name):
    """The user would not learn what to install."""
    with pytest.raises(ClothSimError, match=f'{name} is not installed'):
        message_class(name, UNKNOWN)


@pytest.mark.parametrize('name', ['', 'Header', 'std_msgs/Header', 'std_msgs/srv/Set', '../msg/A'])
def test_what_is_no_type_is_said(name):
    """A broken recording would make Python import something else."""
    with pytest.raises(ClothSimError, match='is not a message type'):
        message_class(name, UNKNOWN)
