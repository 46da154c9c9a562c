# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Definitions of types that a bag brings along."""

from cloth_sim_ros.recording.checked_definition import MOST_ELEMENTS
from cloth_sim_ros.recording.checked_definition import parse_definition
from cloth_sim_ros.recording.message_definition import message_definition
from hostile_mcap import DEFINITIONS
import pytest
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import MessageDefinitionFormat

MSG, IDL = MessageDefinitionFormat.MSG, MessageDefinitionFormat.IDL
POSE = """
module geometry_msgs { module msg {
  module Pose_Constants { const long LIMIT = -3; const string NAME = "a (b) << c"; };
  typedef double double__36[36];
  @verbatim (language="comment", text= "a pose (of (something)) | more")
  struct Pose {
    @verbatim (language="comment", text= "x \\"y\\"") @unit (value="m")
    double__36 covariance;
    sequence<string<10>, 5> names; // of (its) parts | these
    sequence<double> values; /* one << two */
  };
}; };
"""


@pytest.mark.parametrize('name', [
    'cloth_sim_interfaces/msg/ClothState', 'sensor_msgs/msg/PointCloud2',
    'visualization_msgs/msg/MarkerArray', 'rcl_interfaces/msg/ParameterEvent',
    'geometry_msgs/msg/PoseWithCovarianceStamped'])
def test_definitions_of_real_types_are_parsed(name):
    """A recording could not be read at all."""
    assert name in parse_definition(MessageDefinition(MSG, message_definition(name)), name)


def test_an_idl_with_all_that_ros_writes_is_parsed():
    """A recording of a publisher with IDL types could not be read."""
    types = parse_definition(MessageDefinition(IDL, POSE), 'geometry_msgs/msg/Pose')
    assert [name for name, _ in types['geometry_msgs/msg/Pose'][1]] == [
        'covariance', 'names', 'values']


@pytest.mark.parametrize('name', [
    'a long array of words', 'a long array of messages', 'doubled 60 times', 'a long text',
    'idl parentheses', 'idl sequences', 'idl shifts', 'idl operators', 'idl modules',
    'idl annotations'])
def test_what_would_take_forever_is_refused(name):
    """A few bytes would keep every verb until it is killed."""
    text = DEFINITIONS[name]
    kind = IDL if text.startswith('IDL ') else MSG
    with pytest.raises(ValueError, match='its definition has|its arrays|is an array of length 0'):
        parse_definition(MessageDefinition(kind, text.removeprefix('IDL ')), 'a/msg/A')


def test_arrays_of_numbers_may_be_as_long_as_they_like():
    """A message with an image of fixed size could not be read."""
    long = MessageDefinition(MSG, f'uint8[{10**9}] a\nstring[{MOST_ELEMENTS}] b\n')
    assert 'a/msg/A' in parse_definition(long, 'a/msg/A')
