# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Grasp a towel by a corner, carry it along a path, and print the force on the gripper.

    cloth_sim_node --ros-args --params-file config/towel_on_floor.yaml    # in another terminal
    python examples/pick_up_a_corner.py --at -0.2 0.2 0.0
"""

from argparse import ArgumentParser
import sys
from typing import Any

from cloth_sim_interfaces import srv
from geometry_msgs.msg import Pose
from geometry_msgs.msg import WrenchStamped
import rclpy
from rclpy.wait_for_message import wait_for_message

PATH = ((0.0, 0.0, 0.5, 0.0, 1.0), (0.0, -0.1, -0.1, 0.5, 0.866), (0.3, 0.0, 0.0, 0.5, 0.866))


def main() -> None:
    """Grasp, follow PATH, which has ways [m] with x and w of a rotation, and let go."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--node', default='/cloth_sim', help='name, with its namespace')
    parser.add_argument('--at', nargs=3, type=float, default=(-0.2, 0.2, 0.0), help='[m]')
    parser.add_argument('--wait', type=float, default=30.0, help='for an answer [s]')
    args = parser.parse_args()
    rclpy.init()
    node, topic = rclpy.create_node('corner_picker'), f'{args.node}/grasps/wrenches'

    def call(kind: Any, name: str, **fields: Any) -> Any:
        client = node.create_client(kind, f'{args.node}/{name}')
        client.wait_for_service(args.wait) or sys.exit(f'no {args.node}: start cloth_sim_node')
        future = client.call_async(kind.Request(name='hand', **fields))
        rclpy.spin_until_future_complete(node, future, timeout_sec=args.wait)
        answer = future.result() or sys.exit(f'{name}: no answer')
        print(answer.message if answer.success else sys.exit(answer.message))
        return answer

    hand, now = Pose(), 0.0
    place, turn = hand.position, hand.orientation
    place.x, place.y, place.z = args.at
    call(srv.Grasp, 'grasp', pose=hand, radius=0.05)
    for x, y, z, turn.x, turn.w in PATH:
        place.x, place.y, place.z = place.x + x, place.y + y, place.z + z
        arrival = call(srv.MoveFrame, 'move_grasp', pose=hand).arrival
        while now < arrival:
            _, felt = wait_for_message(WrenchStamped, node, topic, time_to_wait=args.wait)
            stamp = felt.header.stamp if felt else sys.exit('no force: it has lost the towel')
            now, force = stamp.sec + 1e-9 * stamp.nanosec, felt.wrench.force
        print(f'at {now:.2f} s the hand feels {force.x:.2f} {force.y:.2f} {force.z:.2f} N')
    call(srv.Release, 'release')


if __name__ == '__main__':
    main()
