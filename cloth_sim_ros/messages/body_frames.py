# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where grasps and colliders are, and what the cloth does to them, in frames of their own."""

from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import replace

from cloth_sim_ros.messages.frame_names import collider_frame
from cloth_sim_ros.messages.frame_names import grasp_frame
from cloth_sim_ros.messages.stamp import stamp
from cloth_sim_ros.sim.contact.contacts import ContactForce
from cloth_sim_ros.sim.held.grasps import Grasp
from cloth_sim_ros.sim.held.grasps import GraspForce
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.pose import Pose
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose as PoseMessage
from geometry_msgs.msg import Quaternion
from geometry_msgs.msg import Transform
from geometry_msgs.msg import TransformStamped
from geometry_msgs.msg import Vector3
from geometry_msgs.msg import Wrench
from geometry_msgs.msg import WrenchStamped
import numpy as np
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage


def body_poses(
        node_name: str, grasps: Sequence[Grasp], colliders: Sequence[Collider]) -> dict[str, Pose]:
    """Return the poses of ``grasps`` and ``colliders`` by the names of their frames."""
    return {
        **{grasp_frame(node_name, grasp.name): grasp.pose for grasp in grasps},
        **{collider_frame(node_name, collider.name): collider.pose for collider in colliders}}


def body_frames(
        poses: Mapping[str, Pose], sim_time: float, frame_id: str, epoch: int = 0) -> TFMessage:
    """
    Return the transforms of ``poses`` at ``sim_time`` [s].

    :param poses: by the names of their frames
    :param frame_id: the parent, frame of the positions
    :param epoch: stamp of simulated time 0 [ns]
    """
    header = Header(stamp=stamp(sim_time, epoch), frame_id=frame_id)
    return TFMessage(transforms=[
        TransformStamped(
            header=header, child_frame_id=name,
            transform=Transform(
                translation=vector(pose.position), rotation=pose_message(pose).orientation))
        for name, pose in poses.items()])


def grasp_wrenches(
        node_name: str, grasps: Sequence[Grasp], forces: Sequence[GraspForce],
        sim_time: float, epoch: int = 0) -> list[WrenchStamped]:
    """
    Return what each of ``grasps`` feels at ``sim_time`` [s], in its frame and about its origin.

    :param node_name: with its namespace
    :param forces: of the cloth on them; those on others are left out
    :param epoch: stamp of simulated time 0 [ns]
    """
    poses = {grasp.name: grasp.pose for grasp in grasps}
    return [
        _wrench(grasp_frame(node_name, felt.name), poses[felt.name], felt, sim_time, epoch)
        for felt in forces if felt.name in poses]


def grasp_peaks(
        node_name: str, grasps: Sequence[Grasp], forces: Sequence[GraspForce],
        sim_time: float, epoch: int = 0) -> list[WrenchStamped]:
    """Return the strongest force in a substep that each of them feels, with a torque of 0."""
    strongest = [replace(felt, force=felt.peak, torque=np.zeros(3)) for felt in forces]
    return grasp_wrenches(node_name, grasps, strongest, sim_time, epoch)


def collider_wrenches(
        node_name: str, colliders: Sequence[Collider], forces: Sequence[ContactForce],
        sim_time: float, epoch: int = 0) -> list[WrenchStamped]:
    """Return the same for ``colliders``."""
    return [
        _wrench(collider_frame(node_name, collider.name), collider.pose, felt, sim_time, epoch)
        for collider, felt in zip(colliders, forces)]


def pose_message(pose: Pose) -> PoseMessage:
    """Return ``pose`` as a message."""
    x, y, z = pose.position
    qx, qy, qz, qw = pose.orientation
    return PoseMessage(
        position=Point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw))


def vector(parts: Sequence[float] | np.ndarray) -> Vector3:
    """Return ``parts``, (3,), as a message."""
    x, y, z = map(float, parts)
    return Vector3(x=x, y=y, z=z)


def _wrench(
        frame: str, pose: Pose, felt: GraspForce | ContactForce,
        sim_time: float, epoch: int) -> WrenchStamped:
    return WrenchStamped(
        header=Header(stamp=stamp(sim_time, epoch), frame_id=frame),
        wrench=Wrench(
            force=vector(pose.axes @ felt.force), torque=vector(pose.axes @ felt.torque)))
