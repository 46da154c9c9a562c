# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What each pin feels, decoded."""

from cloth_sim_ros.messages.pins import MOST_PINS
from cloth_sim_ros.messages.pins import too_many_pins
from cloth_sim_ros.messages.pins import WrenchMessages
from geometry_msgs.msg import WrenchStamped
import numpy as np
import pytest
from rclpy.serialization import deserialize_message


def decode(nodes, forces):
    """Return the messages of a frame with these forces at these nodes."""
    nodes, forces = np.array(nodes, dtype=int).reshape(-1, 2), np.reshape(forces, (-1, 3))
    messages = WrenchMessages('/arm/cloth')
    # Whatever was sent before must not be left in them.
    messages.serialise(nodes, 7.0 + forces, 0.0)
    return [
        deserialize_message(data, WrenchStamped)
        for data in messages.serialise(nodes, forces, 1.25)]


def test_each_pin_has_its_own_message():
    """A gripper would read the force of another one."""
    messages = decode([(0, 0), (2, 3)], [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
    assert [message.header.frame_id for message in messages] == [
        'arm_cloth_pin_0_0', 'arm_cloth_pin_2_3']
    assert {(message.header.stamp.sec, message.header.stamp.nanosec)
            for message in messages} == {(1, 250000000)}


def test_the_force_is_sent_as_it_is():
    """A gripper that holds a weight would feel itself pulled up."""
    message, = decode([(1, 1)], [[0.5, -0.25, -9.81]])
    force, torque = message.wrench.force, message.wrench.torque
    assert (force.x, force.y, force.z) == (0.5, -0.25, -9.81)
    assert (torque.x, torque.y, torque.z) == (0.0, 0.0, 0.0)


def test_a_cloth_without_pins_has_no_messages():
    """A wrench of nothing would be published."""
    assert decode([], []) == []


@pytest.mark.parametrize(('pins', 'told'), [(0, False), (MOST_PINS, False), (MOST_PINS + 1, True)])
def test_too_many_pins_are_told_with_a_way_out(pins, told):
    """The topic would be silent without a word."""
    reason = too_many_pins(pins)
    assert bool(reason) == told
    assert not told or (str(pins) in reason and 'publish.wrenches: false' in reason)
