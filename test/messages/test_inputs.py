# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What was done to the cloth."""

from cloth_sim_interfaces.msg import Command
from cloth_sim_interfaces.msg import FrameTarget
from cloth_sim_interfaces.msg import GraspChange
from cloth_sim_interfaces.msg import PinTarget
from cloth_sim_interfaces.msg import Push as PushMessage
from cloth_sim_ros.messages.body_frames import pose_message
from cloth_sim_ros.messages.inputs import command_message
from cloth_sim_ros.messages.inputs import frame_target_message
from cloth_sim_ros.messages.inputs import grasp_message
from cloth_sim_ros.messages.inputs import mode_message
from cloth_sim_ros.messages.inputs import parameters_message
from cloth_sim_ros.messages.inputs import pin_message
from cloth_sim_ros.messages.inputs import pin_target_message
from cloth_sim_ros.messages.inputs import place_message
from cloth_sim_ros.messages.inputs import push_message
from cloth_sim_ros.messages.inputs import release_message
from cloth_sim_ros.sim.frame_paths import FrameMove
from cloth_sim_ros.sim.grasps import Grasp
from cloth_sim_ros.sim.pins import PinMove
from cloth_sim_ros.sim.pose import Pose
from cloth_sim_ros.sim.push import Push
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_fields import SCENE_FIELDS
import numpy as np
from rclpy.parameter import Parameter
from rclpy.serialization import deserialize_message
from rclpy.serialization import serialize_message
from springs import SPRINGS


def test_a_push_is_told_in_full():
    """A run could not be pushed again as it was."""
    push = Push.checked(
        force=(1.0, 2.0, 3.0), start=4.0, duration=5.0, region='sphere',
        center=(6.0, 7.0, 8.0), radius=9.0)
    message = deserialize_message(
        serialize_message(push_message(push, 0.5, 'world')), PushMessage)
    assert message.header.stamp.nanosec == 500000000 and message.header.frame_id == 'world'
    assert Push(
        force=(message.force.x, message.force.y, message.force.z),
        start=message.start, duration=message.duration, region=message.region,
        center=(message.center.x, message.center.y, message.center.z),
        radius=message.radius) == push


def test_a_target_is_told_in_full():
    """A pin could not be moved again as it was."""
    move = PinMove.checked(row=3, col=4, target=(1.0, 2.0, 3.0), speed=0.25, start=0.5)
    message = deserialize_message(
        serialize_message(pin_target_message(move, 0.5, 'world')), PinTarget)
    assert message.header.stamp.nanosec == 500000000 and message.header.frame_id == 'world'
    assert (message.row, message.col, message.speed) == (3, 4, 0.25)
    assert (message.target.x, message.target.y, message.target.z) == move.target


def test_a_grasp_is_told_in_full():
    """A run could not hold the same nodes again, at the same place."""
    pose = Pose((1.0, 2.0, 3.0), (0.6, 0.0, 0.0, 0.8))
    grasp = Grasp('hand', pose, np.array([[3, 4], [7, 0]]), 2.5)
    message = deserialize_message(
        serialize_message(grasp_message(grasp, 0.5, 'world')), GraspChange)
    assert message.header.stamp.nanosec == 500000000 and message.header.frame_id == 'world'
    assert (message.name, message.grasped, message.max_force) == ('hand', True, 2.5)
    assert list(zip(message.rows, message.cols)) == [(3, 4), (7, 0)]
    assert message.pose == pose_message(pose)
    assert not release_message('hand', False, 0.5, 'world').by_force
    lost = release_message('hand', True, 0.5, 'world')
    assert (lost.name, lost.grasped, lost.by_force) == ('hand', False, True)


def test_a_move_of_a_frame_is_told_in_full():
    """A collider could not be moved again as it was."""
    turn = (0.6, 0.0, 0.0, 0.8)
    for orientation in (None, turn):
        move = FrameMove('ball', (1.0, 2.0, 3.0), orientation, 0.25, 0.75, 0.5)
        message = deserialize_message(
            serialize_message(frame_target_message(move, 0.5, 'world')), FrameTarget)
        assert message.header.stamp.nanosec == 500000000
        assert (message.name, message.speed, message.angular_speed) == ('ball', 0.25, 0.75)
        assert message.keep_orientation == (orientation is None)
        assert orientation is None or message.pose == pose_message(Pose(move.target, turn))
    # A speed of 0 says that it is there.
    place = place_message('ball', Pose((1.0, 2.0, 3.0), turn), 0.5, 'world')
    assert (place.speed, place.pose.position.y) == (0.0, 2.0)


def test_pin_mode_and_command_are_told_with_their_time():
    """The order of inputs would be lost."""
    pin = pin_message(3, 4, True, 0.5, 'world')
    mode = mode_message('adaptive', 'constraint', 0.5, 'world')
    command = command_message(Command.CLEAR_PUSHES, 0.5, 'world')
    assert (pin.row, pin.col, pin.pinned) == (3, 4, True)
    assert (mode.mode, mode.previous_mode) == ('adaptive', 'constraint')
    assert command.command == 'clear_pushes'
    assert {message.header.stamp.nanosec for message in (pin, mode, command)} == {500000000}


def test_a_scene_can_be_made_again_from_its_parameters():
    """A run could not be simulated again from its recording."""
    scene = Scene({**SPRINGS, 'rows': 5, 'cols': 7, 'pins': ['0,0'], 'pushes.start': [0.5],
                   'pushes.duration': [0.25], 'pushes.force': [0.0, 0.0, 1.0]})
    event = parameters_message(scene.values, SCENE_FIELDS, 1.5, 'left/cloth_sim')
    assert event.node == '/left/cloth_sim' and event.stamp.sec == 1
    assert not event.changed_parameters
    again = {
        parameter.name: Parameter.from_parameter_msg(parameter).value
        for parameter in deserialize_message(serialize_message(event), type(event)).new_parameters}
    values = {
        name: list(value) if not isinstance(value, (str, int, float)) else value
        for name, value in again.items()}
    assert Scene(values).values == scene.values


def test_a_change_is_told_as_a_change():
    """A reader would take a change for the whole set of parameters."""
    event = parameters_message(
        {'mode': 'constraint'}, SCENE_FIELDS, 0.0, 'cloth_sim', is_change=True)
    assert not event.new_parameters
    assert [parameter.name for parameter in event.changed_parameters] == ['mode']
