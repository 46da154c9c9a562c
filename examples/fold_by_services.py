# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Fold a towel in half by services, and measure the fold.

    cloth_sim_node --ros-args --params-file config/towel_to_fold.yaml    # in another terminal
    python examples/fold_by_services.py
"""

import sys
from typing import Any

from cloth_sim_interfaces import srv
from geometry_msgs.msg import Pose
import numpy as np
import rclpy
from rclpy.wait_for_message import wait_for_message
from sensor_msgs.msg import PointCloud2

WAIT, HANDS = 60.0, {'left': 0, 'right': -1}  # [s], columns of the first row


def call(kind: Any, service: str, /, **fields: object) -> Any:
    """Return the answer of a service of the node; end where it refuses."""
    client = node.create_client(kind, f'/cloth_sim/{service}')
    client.wait_for_service(WAIT) or sys.exit('no /cloth_sim: start cloth_sim_node')
    future = client.call_async(kind.Request(**fields))
    rclpy.spin_until_future_complete(node, future, timeout_sec=WAIT)
    answer = future.result() or sys.exit(f'{service}: no answer')
    return answer if answer.success else sys.exit(answer.message)


def see(time: float, now: float = -1.0) -> np.ndarray:
    """Return positions [m] and velocities [m/s] from ``time`` [s] on, (rows, cols, 6)."""
    while now < time:
        _, cloud = wait_for_message(PointCloud2, node, '/cloth_sim/points', time_to_wait=WAIT)
        cloud or sys.exit('no /cloth_sim: start cloth_sim_node')
        now = 1e-9 * rclpy.time.Time.from_msg(cloud.header.stamp).nanoseconds
    return np.frombuffer(cloud.data, '<f4').reshape(cloud.height, cloud.width, -1)[..., :6]


rclpy.init()
node, hand = rclpy.create_node('folder'), Pose()
flat = now = see(0.2)
for name, col in HANDS.items():
    hand.position.x, hand.position.y, hand.position.z = flat[0, col, :3].tolist()
    call(srv.Grasp, 'grasp', name=name, pose=hand, radius=0.01, layers='top')
for part, hand.position.z in ((0.04, 0.05), (0.5, 0.17), (0.96, 0.05), (1.0, 0.003)):
    hand.orientation.x, hand.orientation.w = np.sin(part * np.pi / 2), np.cos(part * np.pi / 2)
    for name, col in HANDS.items():
        hand.position.x, hand.position.y = (flat[0] + part * (now[-1] - flat[0]))[col, :2].tolist()
        there = call(srv.MoveFrame, 'move_grasp', name=name, pose=hand, speed=0.2).arrival
    now = see(there)
released, now = call(srv.Release, 'release').message, see(there + 3.0)
areas = [np.ptp(each[..., :2], axis=(0, 1)).prod() for each in (now, flat)]
apart = np.linalg.norm((now[0] - now[-1])[[0, -1], :2], axis=-1).max()
print(f'{released}\n{areas[0] / areas[1]:.3f} of the area, corners {1e3 * apart:.1f} mm apart,',
      f'{1e3 * np.sqrt((now[..., 3:]**2).sum(axis=-1).mean()):.2g} mm/s left')
