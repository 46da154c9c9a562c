# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Frames and wrenches of grasps and colliders, against a simulation on the same device."""

from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_interfaces.srv import Step
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose
from geometry_msgs.msg import Quaternion
import numpy as np

FRAME = 'handled_cloth_sim_{}'


def at_step(cloth, key, steps):
    """Return the messages of that step, when there are any."""
    cloth.client.spin_until(
        lambda: any(cloth.steps_of(message) == steps for message in cloth[key]), key)
    cloth.client.spin_until_quiet()
    return {
        message.header.frame_id: message.wrench for message in cloth[key]
        if cloth.steps_of(message) == steps}


def parts(vector):
    """Return the components of a message as an array."""
    return np.array([vector.x, vector.y, vector.z])


def test_bodies_feel_the_cloth_in_their_own_frames(handled, twin):
    """A sensor in a hand would read in other axes, about another point, or another time."""
    orientation = Quaternion(x=0.0, y=0.6, z=0.0, w=0.8)
    here = Pose(position=Point(x=-0.5, y=-0.3, z=1.0), orientation=orientation)
    assert handled.call(Grasp, 'grasp', name='hand', pose=here, radius=0.2).success
    twin.grasp('hand', (-0.5, -0.3, 1.0), (0.0, 0.6, 0.0, 0.8), radius=0.2)
    to = Pose(position=Point(x=0.0, y=0.0, z=1.0), orientation=orientation)
    assert handled.call(MoveFrame, 'move_collider', name='ball', pose=to).success
    twin.move_collider('ball', (0.0, 0.0, 1.0), (0.0, 0.6, 0.0, 0.8))
    assert handled.call(Step, 'step', steps=60).success
    twin.step(60)
    (felt,), (grasp,) = twin.grasp_forces(), twin.grasps
    wrench = at_step(handled, 'grasps/wrenches', 60)[FRAME.format('grasp_hand')]
    np.testing.assert_array_equal(parts(wrench.force), grasp.pose.axes @ felt.force)
    np.testing.assert_array_equal(parts(wrench.torque), grasp.pose.axes @ felt.torque)
    assert np.linalg.norm(felt.torque) > 1e-3
    wrenches = at_step(handled, 'colliders/wrenches', 60)
    contacts = dict(zip(twin.colliders, twin.contact_forces()))
    assert len(wrenches) == len(contacts) == 2
    for collider, contact in contacts.items():
        wrench = wrenches[FRAME.format(f'collider_{collider.name}')]
        np.testing.assert_array_equal(parts(wrench.force), collider.axes @ contact.force)
        np.testing.assert_array_equal(parts(wrench.torque), collider.axes @ contact.torque)
    assert contacts[twin.colliders[0]].force[2] < -0.1


def test_every_wrench_has_its_frame_and_held_nodes_have_no_other(handled, twin):
    """A viewer could not draw a wrench, or would count the force of a held node twice."""
    here = Pose(position=Point(x=-0.45, y=-0.35, z=1.0))
    assert handled.call(Grasp, 'grasp', name='hand', pose=here, radius=0.12).success
    assert handled.call(Step, 'step', steps=34).success
    at_step(handled, 'grasps/wrenches', 34)
    frames = {
        frame.child_frame_id: (frame.header.frame_id, frame.transform)
        for message in handled['tf'] for frame in message.transforms
        if handled.steps_of(frame) == 34}
    assert set(frames) == {FRAME.format(name) for name in (
        'grasp_hand', 'collider_ball', 'collider_floor', 'pin_0_0', 'pin_0_9')}
    parent, transform = frames[FRAME.format('collider_ball')]
    assert parent == 'world'
    assert parts(transform.translation).tolist() == [0.0, 0.0, 0.85]
    assert set(at_step(handled, 'pins/wrenches', 34)) == {
        FRAME.format('pin_0_0'), FRAME.format('pin_0_9')}


def test_the_parameters_turn_them_off(handled):
    """Topics nobody wants would still cost time."""
    assert handled.set_parameters(publish__wrenches=False, publish__tf=False).successful
    handled.client.spin_until_quiet()
    handled.clear()
    assert handled.call(Step, 'step', steps=2).success
    handled.frame(2)
    handled.client.spin_for(0.2)
    # On /tf there are other nodes, too.
    assert not handled['colliders/wrenches'] and not any(
        frame.child_frame_id.startswith(FRAME.format(''))
        for message in handled['tf'] for frame in message.transforms)
