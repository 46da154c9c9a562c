# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is offered on a topic that is played."""

from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.playback.played_quality import played_quality
from cloth_sim_ros.recording.offered_qos import offered_qos
from cloth_sim_ros.recording.yaml_text import yaml_text
import pytest
from rclpy.qos import DurabilityPolicy
from rclpy.qos import ReliabilityPolicy
from rosbags.rosbag2.metadata import parse_qos

CLOUD = 'sensor_msgs/msg/PointCloud2'


def profiles(*changes):
    """Return profiles like that of the points, but for the changes of each."""
    usual, = offered_qos(TOPICS['points'])
    return parse_qos(yaml_text([{**usual, **change} for change in changes]))


def offered(quality):
    """Return the parts of a quality that tell."""
    return (
        quality.depth, quality.reliability == ReliabilityPolicy.RELIABLE,
        quality.durability == DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.mark.parametrize('key', TOPICS)
def test_what_this_project_recorded_is_offered_again(key):
    """Readers of the simulation would not get what is played, or late ones no topology."""
    topic = TOPICS[key]
    quality = played_quality(
        topic.full_name('cloth_sim'), topic.type_name, parse_qos(yaml_text(offered_qos(topic))))
    assert offered(quality) == (topic.depth, topic.reliable, topic.transient_local)


def test_of_several_publishers_the_best_is_offered():
    """A reader of one of them would get nothing."""
    mixed = profiles(
        {'reliability': 'best_effort'}, {'durability': 'transient_local', 'depth': 3})
    assert offered(played_quality('/a', CLOUD, mixed)) == (10, True, True)
    assert offered(played_quality('/a', CLOUD, mixed[:1])) == (10, False, False)


@pytest.mark.parametrize(('name', 'key', 'depth'), [
    ('/cloth_sim/pins/wrenches', 'pins/wrenches', TOPICS['pins/wrenches'].depth),
    ('/a/cloth_sim/topology', 'topology', TOPICS['topology'].depth),
    ('/scan', 'points', 10)])
def test_a_depth_that_was_not_recorded_is_the_usual_one(name, key, depth):
    """A bag of `ros2 bag record`, which can't know it, would be played with a depth of 0."""
    topic = TOPICS[key]
    unknown = profiles({'history': 'unknown', 'depth': 0})
    assert played_quality(name, topic.type_name, unknown).depth == depth
    assert offered(played_quality(name, topic.type_name, ())) == (depth, True, False)
