# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A topic's quality of service as rosbag2 writes it."""

from cloth_sim_ros.messages.topics import Topic
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.recording.bag_metadata import yaml_text
from cloth_sim_ros.recording.offered_qos import offered_qos
import pytest
import rclpy
from rclpy.context import Context
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from sensor_msgs.msg import PointCloud2

# As rosbag2 of Jazzy dumps it.
LATCHED = """\
- history: keep_last
  depth: 1
  reliability: reliable
  durability: transient_local
  deadline:
    sec: 9223372036
    nsec: 854775807
  lifespan:
    sec: 9223372036
    nsec: 854775807
  liveliness: automatic
  liveliness_lease_duration:
    sec: 9223372036
    nsec: 854775807
  avoid_ros_namespace_conventions: false"""


def test_text_is_that_of_rosbag2():
    """Players would fall back to another quality of service, and late readers get nothing."""
    assert yaml_text(offered_qos(TOPICS['topology'])) == LATCHED


def test_best_effort_and_volatile_have_their_names():
    """Players would refuse the bag because of an unknown policy."""
    profile, = offered_qos(Topic('points', PointCloud2, depth=5, reliable=False))
    assert (profile['reliability'], profile['durability'], profile['depth']) == (
        'best_effort', 'volatile', 5)


@pytest.mark.parametrize('latched', [True, False])
def test_profile_is_what_a_publisher_offers(latched):
    """A played recording would not reach the readers of the simulation."""
    context = Context()
    rclpy.init(context=context)
    node = rclpy.create_node('offers', context=context)
    publisher = node.create_publisher(PointCloud2, 'points', QoSProfile(
        depth=1, reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE))
    info, = node.get_publishers_info_by_topic(publisher.topic_name)
    offered = info.qos_profile
    profile, = offered_qos(Topic('points', PointCloud2, depth=1, transient_local=latched))
    assert profile['reliability'] == offered.reliability.short_key
    assert profile['durability'] == offered.durability.short_key
    assert profile['liveliness'] == offered.liveliness.short_key
    for name in ('deadline', 'lifespan', 'liveliness_lease_duration'):
        limit = profile[name]
        assert limit['sec'] * 10**9 + limit['nsec'] == getattr(offered, name).nanoseconds
    node.destroy_node()
    rclpy.shutdown(context=context)
