# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One topic of a recording on its way out."""

from collections.abc import Iterable
import time
from typing import Any
from typing import Literal

from builtin_interfaces.msg import Time
from cloth_sim_ros.messages.topics import TOPICS
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from rosbags.interfaces import Qos
from rosbags.interfaces import QosDurability
from rosbags.interfaces import QosHistory
from rosbags.interfaces import QosReliability

# Of the 4 bytes before a serialised message the second says how its numbers are laid out.
_ENCAPSULATION = 4
_STAMP = 8
_DEPTH = 10
# A reader on a busy machine is away for tenths of a second; a hung one costs this once.
PATIENCE = 1.0
_SLICE = 0.01


def has_header(message_class: Any) -> bool:
    """Tell whether messages of this class begin with a std_msgs/Header."""
    fields = message_class.get_fields_and_field_types()
    return next(iter(fields.items()), None) == ('header', 'std_msgs/Header')


def header_stamp(data: bytes) -> Time:
    """Return the stamp of ``data``, a serialised message that begins with a header."""
    order: Literal['little', 'big'] = 'little' if data[1] & 1 else 'big'
    parts = data[_ENCAPSULATION:_ENCAPSULATION + _STAMP]
    return Time(
        sec=int.from_bytes(parts[:4], order, signed=True),
        nanosec=int.from_bytes(parts[4:], order))


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


class PlayedTopic:
    """
    Publish serialised messages no faster than reliable readers take them.

    A reliable publisher keeps its last ``depth`` messages until every reader has them, and drops
    the oldest without a word when one more comes. So it is given no more than that at once.

    ``overruns`` counts messages that were sent although a reader had not taken the last ones.

    :param name: in the graph, with its namespace
    :param kept: how many of its messages still hold for those who come late
    :param patience: for a reader to take what it has been sent [s]
    """

    def __init__(
            self, node: Node, name: str, message_class: type, quality: QoSProfile,
            kept: int = 0, patience: float = PATIENCE) -> None:
        """Make the publisher."""
        self.name = name
        self.message_class = message_class
        self.kept = kept
        self.overruns = 0
        self._publisher = node.create_publisher(message_class, name, quality)
        self._is_reliable = quality.reliability == ReliabilityPolicy.RELIABLE
        self._depth = quality.depth
        self._patience = patience
        self._waiting = 0
        self._is_stuck = False

    def publish(self, data: bytes) -> None:
        """Publish ``data``, a serialised message."""
        if self._is_reliable and self._waiting >= self._depth:
            # A reader that has hung is waited for once, and then no more until it is back.
            if self.settle(0.0 if self._is_stuck else self._patience):
                self._is_stuck = False
            else:
                self._is_stuck = True
                self.overruns += 1
        self._publisher.publish(data)
        self._waiting += 1

    def settle(self, patience: float) -> bool:
        """Wait up to ``patience`` [s] until all readers have all of it; tell whether they have."""
        deadline = time.monotonic() + patience
        done = self._is_taken(0.0)
        while not done and time.monotonic() < deadline:
            done = self._is_taken(_SLICE)
        if done:
            self._waiting = 0
        return done

    def _is_taken(self, patience: float) -> bool:
        """Wait up to ``patience`` [s], which no other thread of Python runs in."""
        return self._publisher.get_subscription_count() == 0 or (
            self._publisher.wait_for_all_acked(Duration(seconds=patience)))
