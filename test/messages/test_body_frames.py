# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Frames and wrenches of grasps and colliders."""

import math

from cloth_sim_ros.messages.body_frames import body_frames
from cloth_sim_ros.messages.body_frames import body_poses
from cloth_sim_ros.messages.body_frames import collider_wrenches
from cloth_sim_ros.messages.body_frames import grasp_wrenches
from cloth_sim_ros.sim.contact.contacts import ContactForce
from cloth_sim_ros.sim.held.grasps import Grasp
from cloth_sim_ros.sim.held.grasps import GraspForce
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.pose import Pose
import numpy as np
import pytest

# A quarter turn about z: its x axis is the y axis of the world.
QUARTER = (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))
GRASP = Grasp('hand', Pose((1.0, 2.0, 3.0), QUARTER), np.array([[0, 0]]), 0.0)
BALL = Collider('ball', 'sphere', (0.1,), (4.0, 5.0, 6.0), QUARTER, 0.3)


def parts(vector):
    """Return the components of a message."""
    return vector.x, vector.y, vector.z


def test_each_body_has_its_frame():
    """A viewer would put a gripper elsewhere, or two nodes would have frames of one name."""
    poses = body_poses('/left/arm', [GRASP], [BALL])
    hand, ball = body_frames(poses, 1.5, 'map').transforms
    assert (hand.child_frame_id, ball.child_frame_id) == (
        'left_arm_grasp_hand', 'left_arm_collider_ball')
    assert parts(hand.transform.translation) == (1.0, 2.0, 3.0)
    assert parts(ball.transform.translation) == (4.0, 5.0, 6.0)
    for frame in (hand, ball):
        turn = frame.transform.rotation
        assert (turn.x, turn.y, turn.z, turn.w) == QUARTER
        assert (frame.header.frame_id, frame.header.stamp.nanosec) == ('map', 500000000)


@pytest.mark.parametrize(('make', 'body', 'felt', 'frame'), [
    (grasp_wrenches, GRASP,
     GraspForce('hand', np.array([0.0, 2.0, 1.0]), np.array([3.0, 0.0, 0.0]), np.zeros(3)),
     'arm_grasp_hand'),
    (collider_wrenches, BALL,
     ContactForce('ball', np.array([0.0, 2.0, 1.0]), np.array([3.0, 0.0, 0.0]), 1, 0),
     'arm_collider_ball')])
def test_a_wrench_is_in_the_axes_of_its_frame(make, body, felt, frame):
    """A sensor that turns with the gripper would read along the axes of the world."""
    message, = make('arm', [body], [felt], 1.5)
    assert (message.header.frame_id, message.header.stamp.nanosec) == (frame, 500000000)
    assert parts(message.wrench.force) == pytest.approx((2.0, 0.0, 1.0))
    assert parts(message.wrench.torque) == pytest.approx((0.0, -3.0, 0.0))
