# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Readers of a node's topics that join the graph and leave it again, in order or by a crash.

    python readers.py NODE COUNT SEED    # COUNT readers, one after the other
    python readers.py NODE never         # one that joins and then reads nothing, until killed
"""

import os
import random
import sys
import time

from cloth_sim_interfaces.msg import ClothStats
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import HistoryPolicy
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from sensor_msgs.msg import PointCloud2
from visualization_msgs.msg import MarkerArray

TOPICS = {'points': PointCloud2, 'markers': MarkerArray, 'stats': ClothStats}
LONGEST = 0.6


def join(target: str, quality: QoSProfile) -> Node:
    """Join the graph as a participant of its own, and subscribe to what is large."""
    context = Context()
    rclpy.init(args=[], context=context)
    node = Node(
        f'reader_{os.getpid()}', context=context, start_parameter_services=False,
        enable_rosout=False)
    for name, kind in TOPICS.items():
        node.create_subscription(kind, f'{target}/{name}', lambda message: None, quality)
    return node


def stay(node: Node, seconds: float) -> None:
    """Read for ``seconds``."""
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        executor.spin_once(timeout_sec=0.02)
    executor.shutdown()


def come_and_go(target: str, count: int, chance: random.Random) -> None:
    """Be one reader after the other; the last one ends without leaving."""
    for number in range(count):
        node = join(target, QoSProfile(
            depth=chance.choice((1, 10, 1000)),
            reliability=chance.choice(
                (ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT))))
        # Some leave before anything has come, some in the middle of a message.
        stay(node, chance.choice((0.0, LONGEST)) * chance.random())
        if number == count - 1:
            os._exit(0)
        node.destroy_node()
        rclpy.shutdown(context=node.context)


def main() -> None:
    """Read as the command line says."""
    target, how, *seed = sys.argv[1:]
    if how == 'never':
        node = join(target, QoSProfile(
            depth=1000, history=HistoryPolicy.KEEP_ALL, reliability=ReliabilityPolicy.RELIABLE))
        print(f'{node.get_name()} has joined', flush=True)
        while True:
            time.sleep(60.0)
    come_and_go(target, int(how), random.Random(int(seed[0])))


if __name__ == '__main__':
    main()
