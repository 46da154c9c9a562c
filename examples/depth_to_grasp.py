# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Find the highest corner of a towel at rest in what a camera sees, grasp it there, and lift it.

    cloth_sim_node --ros-args --params-file config/towel_under_camera.yaml  # in another terminal
    python examples/depth_to_grasp.py
"""

from argparse import ArgumentParser
import sys
from typing import Any

from cloth_sim_interfaces import srv
from geometry_msgs import msg
import numpy as np
import rclpy
from rclpy.wait_for_message import wait_for_message
from scipy.ndimage import uniform_filter
from sensor_msgs.msg import Image
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage

CLOTH, WINDOW, CORNER, WAIT = 1, 31, 0.38, 60.0  # label; square [pixel]; share in it; [s]
parser = ArgumentParser(description=__doc__)
parser.add_argument('--node', default='/cloth_sim', help='name, with its namespace')
name = parser.parse_args().node
rclpy.init()
node, front = rclpy.create_node('depth_to_grasp'), f'{name}/cameras/front'


def take(kind: Any, topic: str) -> Any:
    waits = (wait_for_message(kind, node, topic, time_to_wait=WAIT / 9)[1] for _ in range(9))
    return next(filter(None, waits), None) or sys.exit(f'no {topic}')  # None: lost on the way


def call(kind: Any, service: str, place: np.ndarray, **fields: Any) -> None:
    client = node.create_client(kind, f'{name}/{service}')
    client.wait_for_service(WAIT)
    pose = msg.Pose(position=msg.Point(**dict(zip('xyz', map(float, place)))))
    future = client.call_async(kind.Request(name='hand', header=cloud.header, pose=pose, **fields))
    rclpy.spin_until_future_complete(node, future, timeout_sec=WAIT)
    answer = future.result() or sys.exit(f'{service}: no answer')
    print(answer.message if answer.success else sys.exit(answer.message))


cloud, labels, q = take(PointCloud2, f'{front}/points'), take(Image, f'{front}/labels'), None
while q is None:  # the rotation of the optical frame
    frames = {each.child_frame_id: each for each in take(TFMessage, '/tf').transforms}
    q = frames[cloud.header.frame_id].transform.rotation if cloud.header.frame_id in frames else q
cloth = np.frombuffer(labels.data, np.uint8).reshape(cloud.height, cloud.width) == CLOTH
is_corner = cloth & (uniform_filter(cloth.astype(float), WINDOW) < CORNER)
corners = np.frombuffer(cloud.data, np.float32).reshape(-1, 3)[is_corner.ravel()].astype(float)
up = 2.0 * np.array([q.x * q.z - q.w * q.y, q.y * q.z + q.w * q.x, 0.5 - q.x ** 2 - q.y ** 2])
corner = corners[np.argmax(corners @ up)] if len(corners) else sys.exit('no corner is seen')
print(f'corner at {corner.round(3).tolist()} m in {cloud.header.frame_id}')
call(srv.Grasp, 'grasp', corner, radius=0.03)
call(srv.MoveFrame, 'move_grasp', corner + 0.2 * up)
