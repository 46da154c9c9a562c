# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Carry a towel by its two upper corners, as a client of a running node.

    cloth_sim_node    # in another terminal: a cloth on two corners
    python examples/carry_towel.py --by 0.5 0.0 0.3 --speed 0.4
"""

from argparse import ArgumentParser
import sys

from cloth_sim_interfaces.srv import MovePin
from geometry_msgs.msg import Point
import numpy as np
import rclpy
from rclpy.node import Node
from rclpy.wait_for_message import wait_for_message
from sensor_msgs.msg import PointCloud2


def see(node: Node, topic: str, wait: float) -> tuple[float, np.ndarray]:
    """Return the time [s] and the positions (rows, cols, 3) [m] of the next cloud."""
    _, cloud = wait_for_message(PointCloud2, node, topic, time_to_wait=wait)
    cloud = cloud or sys.exit(f'nothing on {topic}: start cloth_sim_node, or give --node')
    words = np.frombuffer(cloud.data, np.float32).reshape(cloud.height, cloud.width, -1)
    return cloud.header.stamp.sec + 1e-9 * cloud.header.stamp.nanosec, words[..., :3]


def main() -> None:
    """Move both pins by the same way at the same time, and wait until they are there."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--node', default='/cloth_sim', help='name, with its namespace')
    parser.add_argument('--by', nargs=3, type=float, default=(0.5, 0.0, 0.3), help='[m]')
    parser.add_argument('--speed', type=float, default=0.4, help='in simulated time [m/s]')
    parser.add_argument('--wait', type=float, default=30.0, help='for an answer [s]')
    args = parser.parse_args()

    rclpy.init()
    node = Node('towel_carrier')
    client = node.create_client(MovePin, f'{args.node}/move_pin')
    now, start = arrival, _ = see(node, f'{args.node}/points', args.wait)
    client.wait_for_service(args.wait) or sys.exit('no service move_pin: start cloth_sim_node')
    for col in (0, start.shape[1] - 1):
        x, y, z = map(float, start[0, col] + np.array(args.by))
        future = client.call_async(MovePin.Request(
            row=0, col=col, target=Point(x=x, y=y, z=z), speed=args.speed))
        rclpy.spin_until_future_complete(node, future, timeout_sec=args.wait)
        answer = future.result() or sys.exit('move_pin: no answer')
        print(answer.message if answer.success else sys.exit(answer.message))
        arrival = max(arrival, answer.arrival)
    while now < arrival:
        now, positions = see(node, f'{args.node}/points', args.wait)
    print(f'the corners have moved by {(positions - start)[0, [0, -1]].round(3).tolist()} m')


if __name__ == '__main__':
    main()
