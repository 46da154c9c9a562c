# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The numbers of a geometry_msgs/Pose."""

from geometry_msgs.msg import Pose


def position_parts(pose: Pose) -> tuple[float, float, float]:
    """Return x, y and z of its position."""
    return pose.position.x, pose.position.y, pose.position.z


def orientation_parts(pose: Pose) -> tuple[float, float, float, float]:
    """Return x, y, z and w of its orientation."""
    turn = pose.orientation
    return turn.x, turn.y, turn.z, turn.w
