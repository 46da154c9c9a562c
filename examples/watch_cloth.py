# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
List the topics of a running node, read its cloth as NumPy arrays, and switch its mode.

    cloth_sim_node --ros-args --params-file config/drape.yaml    # in another terminal
    python examples/watch_cloth.py --mode constraint
"""

from argparse import ArgumentParser
import sys

from cloth_sim_interfaces.srv import SetMode
import numpy as np
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import PointCloud2


def positions_of(cloud: PointCloud2) -> np.ndarray:
    """Return the positions of the nodes, (rows, cols, 3) [m]: the first 3 of 11 words a point."""
    return np.frombuffer(cloud.data, np.float32).reshape(cloud.height, cloud.width, 11)[..., :3]


def main() -> None:
    """Print the lowest point of the cloth in every tenth cloud, before and after the switch."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--node', default='/cloth_sim', help='name, with its namespace')
    parser.add_argument('--clouds', type=int, default=50, help='to read in each mode')
    parser.add_argument('--mode', default='adaptive', help='to switch to')
    parser.add_argument('--wait', type=float, default=30.0, help='for the node [s]')
    args = parser.parse_args()
    rclpy.init()
    node, count = Node('cloth_watcher'), 0

    def see(cloud: PointCloud2) -> None:
        nonlocal count
        if count % 10 == 0:
            time = cloud.header.stamp.sec + 1e-9 * cloud.header.stamp.nanosec
            print(f'{time:.2f} s  lowest {positions_of(cloud)[..., 2].min():.3f} m')
        count += 1

    client = node.create_client(SetMode, f'{args.node}/set_mode')
    client.wait_for_service(args.wait) or sys.exit('no service set_mode: start cloth_sim_node')
    print(*sorted(name for name, _ in node.get_topic_names_and_types()), sep='\n')
    node.create_subscription(PointCloud2, f'{args.node}/points', see, 10)
    while count < args.clouds:
        rclpy.spin_once(node)
    answer = client.call_async(SetMode.Request(mode=args.mode))
    rclpy.spin_until_future_complete(node, answer)
    print(answer.result().message)
    count = 0
    while count < args.clouds:
        rclpy.spin_once(node)


if __name__ == '__main__':
    main()
