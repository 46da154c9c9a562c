# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
A subscriber in a process of its own, which counts the messages of a node.

It prints a line once every topic has had a message, and a line of JSON when its standard input is
closed. Clouds are counted by their stamps: the node makes one per frame.
"""

from argparse import ArgumentParser
from collections.abc import Callable
from collections.abc import Sequence
import json
import sys
import threading
import time
from typing import Any

from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_ros.messages.stamp import NANOSECONDS
from cloth_sim_ros.messages.stamp import STAMP
from cloth_sim_ros.messages.stamp import STAMP_AT
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.study.node_cost import READY
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile
from std_srvs.srv import Trigger

# Always the same: with another time, the executor begins anew.
_TURN = 0.05
_STAMPED = ('points', 'stats')
_PATIENCE = 10.0


class Listener:
    """
    Subscribe reliably to topics of one node, without deserialising what comes.

    :param target: name of the node, with its namespace
    :param keys: the topics, as in TOPICS
    """

    def __init__(self, target: str, keys: Sequence[str]) -> None:
        """Make the subscriptions."""
        self.node = rclpy.create_node('cloth_sim_topic_listener')
        self._target = target
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.node)
        self.counts = dict.fromkeys(keys, 0)
        self.arrivals: dict[str, list[tuple[float, float]]] = {
            key: [] for key in keys if key in _STAMPED}
        for key in keys:
            topic = TOPICS[key]
            # As deep as the publisher: what is lost between the two is lost on the way.
            self.node.create_subscription(
                topic.message, topic.full_name(target), self._count(key),
                QoSProfile(depth=topic.depth), raw=True)

    def spin_until(self, condition: Callable[[], bool], seconds: float = float('inf')) -> bool:
        """Take messages until ``condition`` holds; return False when it does not in time."""
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                return False
            self._executor.spin_once(timeout_sec=_TURN)
        return True

    def call(self, kind: Any, service: str, **fields: Any) -> bool:
        """Call a service of the node, and return whether it has succeeded."""
        client = self.node.create_client(kind, f'/{self._target}/{service}')
        if not self.spin_until(client.service_is_ready, _PATIENCE):
            return False
        answer = client.call_async(kind.Request(**fields))
        return self.spin_until(answer.done, _PATIENCE) and answer.result().success

    def as_dict(self) -> dict[str, Any]:
        """Return the number of messages, and arrivals and stamps [s] of clouds and statistics."""
        return {'counts': self.counts, 'arrivals': self.arrivals}

    def _count(self, key: str) -> Callable[[bytes], None]:
        def count(data: bytes) -> None:
            self.counts[key] += 1
            if key in self.arrivals:
                sec, nanosec = STAMP.unpack_from(data, STAMP_AT)
                self.arrivals[key].append((time.monotonic(), sec + nanosec / NANOSECONDS))
        return count


def main() -> int:
    """Listen until standard input is closed."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('target', help='name of the node')
    parser.add_argument('topics', nargs='+', choices=TOPICS)
    parser.add_argument('--record', action='store_true', help='have the node record meanwhile')
    args = parser.parse_args()
    rclpy.init()
    listener = Listener(args.target, args.topics)
    done = threading.Event()

    def wait_for_the_end() -> None:
        sys.stdin.read()
        done.set()

    threading.Thread(target=wait_for_the_end, daemon=True).start()
    if args.record and not listener.call(StartRecording, 'start_recording'):
        print('the node does not record', flush=True)
        return 1
    listener.spin_until(lambda: done.is_set() or all(listener.counts.values()))
    print(READY, flush=True)
    listener.spin_until(done.is_set)
    found = listener.as_dict()
    if args.record:
        listener.call(Trigger, 'stop_recording')
    print(json.dumps(found), flush=True)
    # The driver ends the process right away.
    sys.stdout.flush()
    return 0


if __name__ == '__main__':
    sys.exit(main())
