# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The quality of service a recorded topic is played with."""

from collections.abc import Iterable

from cloth_sim_ros.messages.topics import TOPICS
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from rosbags.interfaces import Qos
from rosbags.interfaces import QosDurability
from rosbags.interfaces import QosHistory
from rosbags.interfaces import QosReliability

_DEPTH = 10


def played_quality(name: str, type_name: str, offered: Iterable[Qos]) -> QoSProfile:
    """
    Return what to offer on the topic ``name``: the best that any of its publishers offered.

    Whoever could read one of them can read that. Deadlines and lifespans are left out: at another
    pace they would be missed.

    :param offered: profiles of the recorded publishers
    """
    offered = list(offered)
    depth = max((profile.depth for profile in offered
                 if profile.history == QosHistory.KEEP_LAST), default=0)
    reliable = not offered or any(
        profile.reliability != QosReliability.BEST_EFFORT for profile in offered)
    kept = any(profile.durability == QosDurability.TRANSIENT_LOCAL for profile in offered)
    return QoSProfile(
        depth=depth or _usual_depth(name, type_name),
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if kept else DurabilityPolicy.VOLATILE)


def _usual_depth(name: str, type_name: str) -> int:
    """Return the depth where none is recorded: a graph does not tell it, so `ros2 bag` can't."""
    return next(
        (topic.depth for key, topic in TOPICS.items()
         if topic.type_name == type_name and name.endswith(f'/{key}')), _DEPTH)
