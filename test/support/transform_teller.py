# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Transforms on /tf and /tf_static, told until a node knows them."""

from builtin_interfaces.msg import Time
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_ros.messages.body_frames import pose_message
from cloth_sim_ros.messages.body_frames import vector
from cloth_sim_ros.sim.model.pose import Pose
from cloth_under_test import ClothUnderTest
from geometry_msgs.msg import Transform
from geometry_msgs.msg import TransformStamped
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage


def transform(frame: str, parent: str, pose: Pose, time: float = 0.0) -> TransformStamped:
    """Return one transform, at ``time`` [s]."""
    return TransformStamped(
        header=Header(stamp=Time(sec=int(time), nanosec=round(time % 1.0 * 1e9)),
                      frame_id=parent),
        child_frame_id=frame, transform=Transform(
            translation=vector(pose.position), rotation=pose_message(pose).orientation))


class Teller:
    """Publishes transforms."""

    def __init__(self, cloth: ClothUnderTest) -> None:
        """Make the publishers."""
        self.cloth = cloth
        node = cloth.client.node
        self._moving = node.create_publisher(TFMessage, '/tf', 100)
        self._fixed = node.create_publisher(TFMessage, '/tf_static', QoSProfile(
            depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))

    def close(self) -> None:
        """Take the publishers back."""
        for publisher in (self._moving, self._fixed):
            self.cloth.client.node.destroy_publisher(publisher)

    def tell(self, *transforms: TransformStamped, is_fixed: bool = False) -> None:
        """Publish until the node knows the last of ``transforms``."""
        publisher = self._fixed if is_fixed else self._moving
        last = transforms[-1]

        def is_known() -> bool:
            publisher.publish(TFMessage(transforms=list(transforms)))
            header = Header(stamp=last.header.stamp, frame_id=last.child_frame_id)
            return 'there is no collider' in self.refusal(header)

        self.cloth.client.spin_until(is_known, f'{last.child_frame_id} is known')

    def refusal(self, header: Header) -> str:
        """Return why a request with ``header`` is refused, that would do nothing in any case."""
        return self.cloth.call(
            MoveFrame, 'move_collider', header=header, name='nobody').message
