# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Fold a towel by two fingers that move in tf, as a robot's driver or a simulator moves them.

    cloth_sim_node --ros-args --params-file config/tf_fingers.yaml    # in another terminal
    python examples/fold_by_tf.py
"""

import sys

from geometry_msgs.msg import TransformStamped
from geometry_msgs.msg import WrenchStamped
import numpy as np
import rclpy
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage

# Time [s], y and z of the middle between the fingers, room between them [m], turn about x [rad].
WAY = np.array([
    [1.0, -0.135, -0.07, 0.15, 0.0], [1.8, -0.124, -0.07, 0.007, 0.0],
    [2.2, -0.124, -0.07, 0.007, 0.0], [2.6, -0.224, -0.06, 0.007, 0.0],
    [3.0, -0.224, 0.1, 0.007, 0.0], [4.6, 0.08, 0.1, 0.007, -3.14],
    [4.8, 0.12, 0.06, 0.007, -3.14], [5.2, 0.12, 0.06, 0.007, -3.14],
    [5.8, 0.12, 0.06, 0.03, -3.14], [6.5, 0.12, 0.2, 0.03, -3.14]])


def transform(name: str, side: float, now: float, stamp: object) -> TransformStamped:
    """Return where a finger is, whose pad is 1 cm from its middle."""
    y, z, room, turn = (float(np.interp(now, WAY[:, 0], column)) for column in WAY[:, 1:].T)
    found, away = TransformStamped(child_frame_id=name), side * (0.5 * room + 0.01)
    found.header.frame_id, found.header.stamp = 'world', stamp
    place, rotation = found.transform.translation, found.transform.rotation
    place.y, place.z = y + away * np.cos(turn), z + away * np.sin(turn)
    rotation.x, rotation.w = np.sin(0.5 * turn), np.cos(0.5 * turn)
    return found


def note(message: WrenchStamped) -> None:
    """Keep the force on a finger, and the time of the cloth."""
    forces[message.header.frame_id.rpartition('_')[2]] = message.wrench.force.y
    forces['time'] = message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec


rclpy.init()
node, forces = rclpy.create_node('robot'), {'time': 0.0}
clock, tf = (node.create_publisher(*each, 10) for each in ((Clock, '/clock'), (TFMessage, '/tf')))
node.create_subscription(WrenchStamped, '/cloth_sim/colliders/wrenches', note, 10)
for tick in range(round(100 * float(sys.argv[1] if len(sys.argv) > 1 else 7.0))):
    now, stamp = 0.01 * tick, rclpy.time.Time(nanoseconds=10_000_000 * (tick + 1)).to_msg()
    tf.publish(TFMessage(transforms=[
        transform('finger_front', -1.0, now, stamp), transform('finger_back', 1.0, now, stamp)]))
    clock.publish(Clock(clock=stamp))
    while forces['time'] < now - 0.1:  # until the cloth has come so far
        clock.publish(Clock(clock=stamp))
        rclpy.spin_once(node, timeout_sec=0.01)
    if tick % 50 == 49:
        print(f'{now:4.2f} s', *(f'{name} {forces[name]:5.2f} N' for name in ('front', 'back')))
