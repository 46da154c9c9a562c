# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One topic of a recording on its way out."""

import time

from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy

# A reader on a busy machine is away for tenths of a second; a hung one costs this once.
PATIENCE = 1.0
_SLICE = 0.01


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
